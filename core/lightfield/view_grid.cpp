// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/view_grid.h"

#include <charconv>
#include <cmath>

namespace fieldcast {

std::optional<std::string> grid_problem(const ViewGrid& grid) {
    const std::string name = "grid " + std::to_string(grid.rows) + "x" + std::to_string(grid.cols);
    if (grid.rows == 0 || grid.cols == 0) {
        return name + ": rows and columns start at 1";
    }
    if (grid.rows > kMaxViews || grid.cols > kMaxViews || grid.rows * grid.cols > kMaxViews) {
        const std::uint64_t views = static_cast<std::uint64_t>(grid.rows) * grid.cols;
        return name + ": " + std::to_string(views) + " views, at most " + std::to_string(kMaxViews);
    }
    const glm::vec2 spacing = grid.geometry.spacing_m;
    if (!std::isfinite(spacing.x) || !std::isfinite(spacing.y) || spacing.x < 0.0F || spacing.y < 0.0F) {
        return name + ": spacing must be finite and not negative";
    }
    if (!(grid.geometry.convergence_m > 0.0F)) {
        return name + ": convergence distance must be positive (infinity: parallel cameras)";
    }
    return std::nullopt;
}

namespace {

/// Reads two numbers with an x between them.
std::optional<std::pair<std::uint32_t, std::uint32_t>> parse_product(const std::string& text) {
    std::pair<std::uint32_t, std::uint32_t> factors;
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, factors.first);
    if (first.ec != std::errc{} || first.ptr == end || (*first.ptr != 'x' && *first.ptr != 'X')) {
        return std::nullopt;
    }
    const auto second = std::from_chars(first.ptr + 1, end, factors.second);
    return second.ec == std::errc{} && second.ptr == end ? std::optional(factors) : std::nullopt;
}

} // namespace

std::optional<ViewGrid> parse_grid(const std::string& text) {
    const auto factors = parse_product(text);
    if (!factors) {
        return std::nullopt;
    }
    ViewGrid grid;
    grid.rows = factors->first;
    grid.cols = factors->second;
    return grid;
}

std::optional<glm::uvec2> parse_size(const std::string& text) {
    const auto factors = parse_product(text);
    return factors ? std::optional(glm::uvec2(factors->first, factors->second)) : std::nullopt;
}

LatticePosition lattice_position(const ViewGrid& grid, std::uint32_t row, std::uint32_t col) {
    const auto r = static_cast<std::int32_t>(row);
    const auto c = static_cast<std::int32_t>(col);
    const auto last_row = static_cast<std::int32_t>(grid.rows) - 1;
    const auto last_col = static_cast<std::int32_t>(grid.cols) - 1;
    if (grid.anchor == Anchor::kCentre) {
        return {2 * r - last_row, 2 * c - last_col};
    }
    return LatticePosition::whole(r - last_row / 2, c - last_col / 2);
}

std::vector<LatticePosition> lattice_positions(const ViewGrid& grid) {
    std::vector<LatticePosition> positions;
    positions.reserve(grid.view_count());
    for (std::uint32_t row = 0; row < grid.rows; ++row) {
        for (std::uint32_t col = 0; col < grid.cols; ++col) {
            positions.push_back(lattice_position(grid, row, col));
        }
    }
    return positions;
}

std::vector<LatticePosition> middle_source() {
    return {kMiddleSource.begin(), kMiddleSource.end()};
}

Camera moved_camera(Camera camera, const LatticeGeometry& geometry, LatticePosition position) {
    const glm::vec2 offset_m(position.col() * geometry.spacing_m.x, position.row() * geometry.spacing_m.y);
    const glm::vec3 right(camera.world_from_camera[0]);
    const glm::vec3 up(camera.world_from_camera[1]);
    camera.world_from_camera[3] += glm::vec4(right * offset_m.x - up * offset_m.y, 0.0F);
    camera.principal_px += offset_m * (camera.focal_px / geometry.convergence_m); // zero for parallel cameras
    return camera;
}

Camera view_camera(const Camera& source, const LatticeGeometry& geometry, LatticePosition position, float fovy_rad,
                   std::uint32_t width_px, std::uint32_t height_px) {
    return moved_camera(make_camera(source.world_from_camera, fovy_rad, width_px, height_px), geometry, position);
}

float disparity_px(float focal_px, float spacing_m, float depth_m, float convergence_m) {
    return focal_px * spacing_m * (1.0F / depth_m - 1.0F / convergence_m);
}

} // namespace fieldcast
