// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/views.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace fieldcast::image {

/// Ways through the views of a grid. Both are closed loops that only step to a neighbour, also from the end to the
/// start, so the parallax looks continuous.
enum class SweepPath : std::uint8_t {
    kSerpentine, ///< all views, row by row with alternating direction, and the same way back
    kCircle,     ///< clockwise along the border of the grid; of a single row or column there and back
};

/// Row-major indices of the views in the order shown, without the repeated first one.
std::vector<std::uint32_t> sweep_order(const ViewGrid& grid, SweepPath path);

/// Writes an animated PNG that looks around in the light field: `views` are those of `grid`, each frame lasts `delay`.
void write_look_around(const std::filesystem::path& file, const ViewGrid& grid, std::span<const View> views,
                       SweepPath path, std::chrono::milliseconds delay);

} // namespace fieldcast::image
