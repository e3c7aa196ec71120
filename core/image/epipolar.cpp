// SPDX-License-Identifier: Apache-2.0
// Epipolar plane images: R. C. Bolles, H. H. Baker, D. H. Marimont. Epipolar-Plane Image Analysis: An Approach to
// Determining Structure from Motion. IJCV 1(1), 1987.
#include "core/image/epipolar.h"

#include "core/base/error.h"
#include "core/image/ssim_window.h"

#include <algorithm>

namespace fieldcast::image {

namespace {

/// The five images of which SSIM takes window means, of one slice: views × pixels.
struct Slice {
    std::size_t views = 0;
    std::size_t pixels = 0;
    std::vector<WindowMeans> values;

    WindowMeans& at(std::size_t view, std::size_t pixel) { return values[view * pixels + pixel]; }
    const WindowMeans& at(std::size_t view, std::size_t pixel) const { return values[view * pixels + pixel]; }
};

void add(WindowMeans& sum, const WindowMeans& value, double weight) {
    sum.x += weight * value.x;
    sum.y += weight * value.y;
    sum.xx += weight * value.xx;
    sum.yy += weight * value.yy;
    sum.xy += weight * value.xy;
}

Slice make_slice(std::span<const RgbF32> views, std::span<const RgbF32> references, ViewLine line, std::size_t index) {
    const std::size_t width = views[0].width_px;
    Slice slice{views.size(), line == ViewLine::kRow ? width : views[0].height_px, {}};
    slice.values.reserve(slice.views * slice.pixels);
    for (std::size_t view = 0; view < slice.views; ++view) {
        for (std::size_t i = 0; i < slice.pixels; ++i) {
            const std::size_t at = line == ViewLine::kRow ? index * width + i : i * width + index;
            const double x = luma(views[view].pixels[at]);
            const double y = luma(references[view].pixels[at]);
            slice.values.push_back({x, y, x * x, y * y, x * y});
        }
    }
    return slice;
}

/// Window means along the pixels, where the window lies inside.
Slice mean_along_pixels(const Slice& slice) {
    Slice result{slice.views, slice.pixels - 2 * kSsimRadius, {}};
    result.values.resize(result.views * result.pixels);
    for (std::size_t view = 0; view < result.views; ++view) {
        for (std::size_t i = 0; i < result.pixels; ++i) {
            for (std::size_t tap = 0; tap < ssim_taps().size(); ++tap) {
                add(result.at(view, i), slice.at(view, i + tap), ssim_taps()[tap]);
            }
        }
    }
    return result;
}

/// Window means along the views; the window is cut off at both ends.
Slice mean_along_views(const Slice& slice) {
    Slice result{slice.views, slice.pixels, std::vector<WindowMeans>(slice.values.size())};
    for (std::size_t view = 0; view < slice.views; ++view) {
        const std::size_t first = view > kSsimRadius ? view - kSsimRadius : 0;
        const std::size_t last = std::min(slice.views - 1, view + kSsimRadius);
        double weights = 0.0;
        for (std::size_t other = first; other <= last; ++other) {
            weights += ssim_taps()[other + kSsimRadius - view];
        }
        for (std::size_t other = first; other <= last; ++other) {
            const double weight = ssim_taps()[other + kSsimRadius - view] / weights;
            for (std::size_t i = 0; i < slice.pixels; ++i) {
                add(result.at(view, i), slice.at(other, i), weight);
            }
        }
    }
    return result;
}

void check(std::span<const RgbF32> views, std::span<const RgbF32> references, ViewLine line) {
    FC_ASSERT(views.size() >= 2 && views.size() == references.size(), "a line of views, and a reference of each");
    const std::uint32_t width = views[0].width_px;
    const std::uint32_t height = views[0].height_px;
    FC_ASSERT((line == ViewLine::kRow ? width : height) > 2 * kSsimRadius && width > 0 && height > 0,
              "the window fits into the slice");
    for (std::size_t i = 0; i < views.size(); ++i) {
        for (const RgbF32* image : {&views[i], &references[i]}) {
            FC_ASSERT(image->width_px == width && image->height_px == height &&
                          image->pixels.size() == static_cast<std::size_t>(width) * height,
                      "views have one size and all their pixels");
        }
    }
}

} // namespace

double epi_ssim(std::span<const RgbF32> views, std::span<const RgbF32> references, ViewLine line) {
    check(views, references, line);
    const std::size_t slices = line == ViewLine::kRow ? views[0].height_px : views[0].width_px;
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t index = 0; index < slices; ++index) {
        for (const WindowMeans& means :
             mean_along_views(mean_along_pixels(make_slice(views, references, line, index))).values) {
            sum += ssim_of(means);
            count += 1.0;
        }
    }
    return sum / count;
}

} // namespace fieldcast::image
