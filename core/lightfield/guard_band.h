// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/view_grid.h"

#include <span>

namespace fieldcast {

/// How a guard band was chosen; both numbers are reported to the user.
struct GuardBandChoice {
    GuardBand band;
    double removed_share = 0.0; ///< of the out-of-frustum pixels of the largest grid, 0 … 1
    double extra_share = 0.0;   ///< additional source pixels relative to the image, 0 … 0.12
};

/// Smallest band that removes ≥ `target_share` of the out-of-frustum pixels of `largest`, capped at `max_extra_share`
/// more source pixels (docs/lightfield.md, guard band).
/// `depth_m` is the depth image of a camera already widened by `widest` (row-major, size of that camera; infinity: sky)
/// so that the disparity of points just outside the source image is known.
GuardBandChoice choose_guard_band(const Camera& source, const GuardBand& widest, std::span<const float> depth_m,
                                  const ViewGrid& largest, double target_share = 0.95, double max_extra_share = 0.12);

/// A band certainly large enough to measure with: `grid`'s offsets × the disparity at `nearest_m`, at most
/// half the image size on each side.
GuardBand widest_guard_band(const Camera& source, const ViewGrid& grid, float nearest_m);

} // namespace fieldcast
