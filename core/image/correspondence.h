// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image_file.h"
#include "core/lightfield/camera.h"

#include <limits>
#include <optional>

namespace fieldcast::image {

/// Surfaces that the pixels of a view show: ground truth for comparing views with each other.
struct ViewSurfaces {
    Camera camera;
    std::vector<float> depth_m;        ///< along the viewing axis, row-major; infinity: nothing was hit
    std::vector<std::uint32_t> object; ///< any number per object; all pixels that hit nothing have the same number
};

/// Places of one view's pixels in another view, or in the same view at another time.
struct Correspondence {
    std::uint32_t width_px = 0; ///< of both views
    std::uint32_t height_px = 0;
    std::vector<std::optional<glm::vec2>> place; ///< row-major, pixels, centres at +0.5; none: not visible there
};

/// Finds the point that each pixel of `target` shows in `source`. A point counts as visible there if all four pixels
/// around it show the same object, and 1/depth between them agrees with the point's within 1 %: 1/depth of a plane is
/// linear in the image, so surfaces at grazing angles pass too. `source_from_target` maps world space of each object
/// from the time of `target` to the time of `source`; empty: nothing moved. Both views have one size.
Correspondence find_correspondence(const ViewSurfaces& target, const ViewSurfaces& source,
                                   const std::vector<glm::mat4>& source_from_target = {});

/// Bilinear sample of `image`. `place` lies within the centres of the outermost pixels.
glm::vec3 sample_bilinear(const RgbF32& image, glm::vec2 place);

/// Mean of |target − source at the corresponding place| over visible pixels and channels; empty if none is visible. For
/// two successive frames it is the warped temporal error. For the error images of two views of a light field it
/// measures how much the errors differ, and thus how inconsistent the views are.
std::optional<double> warped_difference(const RgbF32& target, const RgbF32& source, const Correspondence& map);

/// image − reference, per pixel and channel.
RgbF32 error_image(const RgbF32& image, const RgbF32& reference);

} // namespace fieldcast::image
