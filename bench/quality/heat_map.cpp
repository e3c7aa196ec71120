// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/heat_map.h"

#include "core/base/error.h"

#include <algorithm>
#include <array>

namespace fieldcast::bench {

namespace {

constexpr std::uint32_t kSquarePx = 48;
constexpr std::uint32_t kGapPx = 2;
constexpr std::uint32_t kDotPx = 12;

/// Dark violet, blue, green, yellow. Its brightness grows evenly, so it is readable without colours.
glm::vec3 ramp(double value) {
    constexpr std::array<glm::vec3, 4> kColours{glm::vec3(0.16F, 0.05F, 0.30F), glm::vec3(0.15F, 0.35F, 0.60F),
                                                glm::vec3(0.20F, 0.68F, 0.47F), glm::vec3(0.99F, 0.91F, 0.25F)};
    const float at = static_cast<float>(std::clamp(value, 0.0, 1.0)) * static_cast<float>(kColours.size() - 1);
    const auto low = std::min(static_cast<std::size_t>(at), kColours.size() - 2);
    return glm::mix(kColours[low], kColours[low + 1], at - static_cast<float>(low));
}

void fill(Plane& plane, std::uint32_t x0, std::uint32_t y0, std::uint32_t size_px, const glm::vec3& colour) {
    for (std::uint32_t y = y0; y < y0 + size_px; ++y) {
        for (std::uint32_t x = x0; x < x0 + size_px; ++x) {
            for (int c = 0; c < 3; ++c) {
                const std::size_t at =
                    3 * (static_cast<std::size_t>(y) * plane.width_px + x) + static_cast<std::size_t>(c);
                plane.bytes[at] = static_cast<std::byte>(colour[c] * 255.0F + 0.5F);
            }
        }
    }
}

} // namespace

Plane heat_map(const ViewGrid& grid, std::span<const double> values, double brightest,
               const std::vector<LatticePosition>& sources) {
    FC_ASSERT(values.size() == grid.view_count(), "a value per view");
    constexpr std::uint32_t kStep = kSquarePx + kGapPx;
    Plane plane{PlaneSemantic::kColour, PlaneFormat::kRgb8, grid.cols * kStep - kGapPx, grid.rows * kStep - kGapPx, {}};
    plane.bytes.resize(plane_bytes(plane.format, plane.width_px, plane.height_px), std::byte{255});
    for (std::uint32_t row = 0; row < grid.rows; ++row) {
        for (std::uint32_t col = 0; col < grid.cols; ++col) {
            const double value = values[static_cast<std::size_t>(row) * grid.cols + col];
            fill(plane, col * kStep, row * kStep, kSquarePx, ramp(brightest > 0.0 ? value / brightest : 0.0));
            if (std::ranges::find(sources, lattice_position(grid, row, col)) != sources.end()) {
                const std::uint32_t inset = (kSquarePx - kDotPx) / 2;
                fill(plane, col * kStep + inset, row * kStep + inset, kDotPx, glm::vec3(1.0F));
            }
        }
    }
    return plane;
}

} // namespace fieldcast::bench
