// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image_file.h"

#include <span>

namespace fieldcast::image {

/// One view of a light field that is refocused.
struct ShiftedView {
    const RgbF32* image = nullptr; ///< linear light
    glm::vec2 shift_px{0.0F};      ///< a point at x in the refocused image lies at x + shift in this one
};

/// Refocuses a light field at one depth, as an eye or lens does (shift and add): the mean of all views, each shifted so
/// that points of that depth fall together. Where some shifted views end, the mean is of the others; where all end, it
/// is 0. Views have one size; there is at least one.
RgbF32 refocus(std::span<const ShiftedView> views);

/// `count` ≥ 2 depths, metres, nearest last, equally spaced in 1/depth between the 5 % and 95 % quantiles of what a
/// view sees (infinity counts as 1/depth 0, so the first may be infinite). `depth_m` is not empty.
std::vector<float> focal_depths(std::vector<float> depth_m, std::size_t count);

} // namespace fieldcast::image
