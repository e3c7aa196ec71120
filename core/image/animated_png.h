// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/plane.h"

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace fieldcast::image {

/// Lossless animation that every browser plays in an <img>, in an endless loop. `frames` are kRgb8 planes of one size,
/// in the order shown; a plane may appear several times and is then compressed once. Each is shown for `delay`, at most
/// 65 s. Programs without support for animation show the first frame.
std::vector<std::byte> encode_animated_png(std::span<const Plane* const> frames, std::chrono::milliseconds delay);

/// Writes the animation as a file that appears complete or not at all. Throws std::system_error.
void write_animated_png(const std::filesystem::path& file, std::span<const Plane* const> frames,
                        std::chrono::milliseconds delay);

} // namespace fieldcast::image
