// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/vocabulary.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fieldcast {

std::uint32_t bytes_per_pixel(PlaneFormat format); ///< 0 for a value that is not a format

/// Limits for planes from untrusted sources.
inline constexpr std::uint32_t kMaxPlaneSide = 16384;
inline constexpr std::uint64_t kMaxPlaneBytes = 256ULL << 20;

/// An image in wire precision: `height_px` rows of `width_px` pixels, tightly packed.
struct Plane {
    PlaneSemantic semantic = PlaneSemantic::kColour;
    PlaneFormat format = PlaneFormat::kRgb8;
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    std::vector<std::byte> bytes;

    bool operator==(const Plane&) const = default;
};

/// Size of a plane's pixels, bytes; empty planes have 0.
std::uint64_t plane_bytes(PlaneFormat format, std::uint32_t width_px, std::uint32_t height_px);

} // namespace fieldcast
