// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/camera.h"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace fieldcast {

inline constexpr std::uint32_t kMaxViews = 72; ///< rows · columns of one grid

/// Position of a view relative to the source, in half steps so that centred even grids are exact.
/// Row 0 is the source's; rows grow downwards, columns to the right, as seen by the camera.
struct LatticePosition {
    std::int32_t row_halves = 0;
    std::int32_t col_halves = 0;

    static LatticePosition whole(std::int32_t row, std::int32_t col) { return {2 * row, 2 * col}; }
    float row() const { return static_cast<float>(row_halves) * 0.5F; }
    float col() const { return static_cast<float>(col_halves) * 0.5F; }
    auto operator<=>(const LatticePosition&) const = default;
};

inline constexpr std::array kMiddleSource{LatticePosition{}}; ///< one source, where the lattice has its origin
std::vector<LatticePosition> middle_source();                 ///< the same

/// Geometry that all views of one lattice share. Views of equal geometry, size and position are the same view.
struct LatticeGeometry {
    glm::vec2 spacing_m{0.03F}; ///< distance of neighbouring views: x between columns, y between rows
    float convergence_m = std::numeric_limits<float>::infinity(); ///< depth of zero disparity; infinity: parallel

    bool operator==(const LatticeGeometry&) const = default;
};

enum class Anchor : std::uint8_t {
    kLattice, ///< the source is view (⌊(R−1)/2⌋, ⌊(C−1)/2⌋); all such grids nest
    kCentre,  ///< symmetric about the source; even grids lie half a step off the lattice
};

/// R×C views of one light field; view(row, col) has row 0 on top, col 0 on the left.
struct ViewGrid {
    std::uint32_t rows = 6;
    std::uint32_t cols = 6;
    LatticeGeometry geometry;
    Anchor anchor = Anchor::kLattice;

    std::uint32_t view_count() const { return rows * cols; }
    bool operator==(const ViewGrid&) const = default;
};

/// Why `grid` cannot be served ("grid 9x9: 81 views, at most 72"), or nothing.
std::optional<std::string> grid_problem(const ViewGrid& grid);

/// Reads "4x4", "1x45". Empty if malformed; does not check limits.
std::optional<ViewGrid> parse_grid(const std::string& text);

/// Reads "640x360": width and height, pixels. Empty if malformed; does not check limits.
std::optional<glm::uvec2> parse_size(const std::string& text);

/// Lattice position of view (row, col). Row-major order everywhere.
LatticePosition lattice_position(const ViewGrid& grid, std::uint32_t row, std::uint32_t col);
std::vector<LatticePosition> lattice_positions(const ViewGrid& grid);

/// `camera` of lattice position (0, 0), moved to `position`: parallel, with the shear for the convergence distance.
Camera moved_camera(Camera camera, const LatticeGeometry& geometry, LatticePosition position);

/// Camera of a view. `source` is the camera of position (0, 0) without guard band; the view has the given size, and the
/// vertical field of view `fovy_rad` over its height. Implements x_source = x_target + Δcol·d (docs/lightfield.md).
Camera view_camera(const Camera& source, const LatticeGeometry& geometry, LatticePosition position, float fovy_rad,
                   std::uint32_t width_px, std::uint32_t height_px);

/// Disparity per whole step, pixels: f·b·(1/z − 1/z_c).
float disparity_px(float focal_px, float spacing_m, float depth_m, float convergence_m);

} // namespace fieldcast
