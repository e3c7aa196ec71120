// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image_file.h"
#include "report/page.h"

namespace fieldcast::report {

/// Part of an image.
struct Crop {
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    std::uint32_t width = 0;
    std::uint32_t height = 0;

    bool operator==(const Crop&) const = default;
};

/// The window of at most `width` × `height` in which the summed square of `errors` is largest, among those that lie
/// half a window apart.
Crop worst_crop(const image::RgbF32& errors, std::uint32_t width, std::uint32_t height);

image::RgbF32 cropped(const image::RgbF32& image, const Crop& crop);

/// Mean of the absolute errors of the three channels as colours, from black (0) to pale yellow (`largest` and more).
image::RgbF32 error_map(const image::RgbF32& errors, float largest);

/// The same colours as a strip for a legend, from 0 to `largest`.
Markup error_scale(float largest);

/// A picture of a page, display-referred.
struct Picture {
    std::string label;
    std::string numbers; ///< small, below the label
    image::RgbF32 display;
    bool begins_row = false; ///< starts a new row where pictures stand beside each other
};

/// Pictures of one size: a viewer that shows one of them at a time in the same place, chosen by tabs (or arrow keys),
/// and all of them beside each other. Their pixels stand once in the page's style sheet. At most 16, once per page.
Markup compare_pictures(Page& page, const std::vector<Picture>& pictures);

} // namespace fieldcast::report
