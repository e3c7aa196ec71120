// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/correspondence.h"
#include "core/lightfield/view_grid.h"

#include <nlohmann/json.hpp>

namespace fieldcast::bench {

/// All views of one light field at one moment, row-major as in the grid.
struct LightFieldPictures {
    std::vector<image::RgbF32> views;      ///< linear
    std::vector<image::RgbF32> references; ///< linear, path traced with many samples
    std::vector<image::ViewSurfaces> surfaces;
};

/// Measures of a whole light field:
///   views            row, col, rmse and ssim of each view
///   rmse, ssim       mean, min, max and deviation over the views
///   angular_error    mean over neighbouring views v, u, pixels that both show, and channels of
///                    |(v − u moved to v) − (the same for the references)|: 0 if errors stick to surfaces
///   epi_ssim         structural similarity of epipolar slices, mean over rows and columns of views
///   refocus          depth_m, rmse and ssim of the light field refocused at five depths
///   refocus_rmse, refocus_ssim   their means
/// All use display-referred values; views are refocused in the linear light that a display emits.
nlohmann::ordered_json light_field_scores(const ViewGrid& grid, const LightFieldPictures& pictures, float exposure);

} // namespace fieldcast::bench
