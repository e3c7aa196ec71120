// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image_file.h"
#include "core/lightfield/camera.h"

#include <limits>
#include <optional>

namespace fieldcast::image {

/// What the pixels of a view see, as ground truth for comparing views with each other.
struct ViewSurfaces {
    Camera camera;
    std::vector<float> depth_m;        ///< along the viewing axis, row-major; infinity: nothing was hit
    std::vector<std::uint32_t> object; ///< any number per object; of pixels that hit nothing: the same number
};

/// Where the pixels of one view lie in another view, or in the same view at another time.
struct Correspondence {
    std::uint32_t width_px = 0; ///< of both views
    std::uint32_t height_px = 0;
    std::vector<std::optional<glm::vec2>> place; ///< row-major, pixels, centres at +0.5; none: not visible there
};

/// Finds what each pixel of `target` sees in `source`. A point counts as visible there if all four pixels around it
/// show the same object, and 1/depth between them agrees with the point's within 1 %: 1/depth of a plane is linear in
/// the image, so surfaces at grazing angles pass too. `source_from_target`: world space of each object when `source`
/// was made from that when `target` was made; empty: nothing moved. Both views have one size.
Correspondence find_correspondence(const ViewSurfaces& target, const ViewSurfaces& source,
                                   const std::vector<glm::mat4>& source_from_target = {});

/// `image` between its pixels, bilinear. `place` lies within the centres of the outermost pixels.
glm::vec3 sample_bilinear(const RgbF32& image, glm::vec2 place);

/// Mean of |target − source at the corresponding place| over visible pixels and channels; empty if none is visible.
/// Of two successive frames: the warped temporal error. Of the error images of two views of a light field: how far the
/// errors differ between them, so how inconsistent the views are.
std::optional<double> warped_difference(const RgbF32& target, const RgbF32& source, const Correspondence& map);

/// image − reference, per pixel and channel.
RgbF32 error_image(const RgbF32& image, const RgbF32& reference);

} // namespace fieldcast::image
