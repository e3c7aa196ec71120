// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/view_grid.h"

#include <span>

namespace fieldcast {

/// A chosen guard band, and two numbers that are reported to the user.
struct GuardBandChoice {
    GuardBand band;
    double removed_share = 0.0; ///< of the out-of-frustum pixels of the largest grid, 0 … 1
    double extra_share = 0.0;   ///< additional source pixels relative to the image, 0 … 0.12
};

inline constexpr double kGuardBandTarget = 0.95; ///< share of out-of-frustum pixels
inline constexpr double kGuardBandCap = 0.12;    ///< share of source pixels

/// Smallest band that removes ≥ `target_share` of the out-of-frustum pixels of `largest`, capped at `max_extra_share`
/// more source pixels (docs/lightfield.md, guard band).
/// `depth_m` is the depth image of a camera already widened by `widest` (row-major, size of that camera; infinity: sky)
/// so that the disparity of points just outside the source image is known. `at` is the source's lattice position.
GuardBandChoice choose_guard_band(const Camera& source, const GuardBand& widest, std::span<const float> depth_m,
                                  const ViewGrid& largest, double target_share = kGuardBandTarget,
                                  double max_extra_share = kGuardBandCap, LatticePosition at = {});

/// An upper bound of the guard band, for measuring: `grid`'s offsets × the disparity at `nearest_m`, at most half the
/// image size on each side.
GuardBand widest_guard_band(const Camera& source, const ViewGrid& grid, float nearest_m, LatticePosition at = {});

} // namespace fieldcast
