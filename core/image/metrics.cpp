// SPDX-License-Identifier: Apache-2.0
// SSIM (ssim_window.h): the mean leaves out the 5 px border where the window would leave the image, as scikit-image
// does.
#include "core/image/metrics.h"

#include "core/base/error.h"
#include "core/image/ssim_window.h"
#include "core/image/transfer.h"

#include <algorithm>
#include <cmath>

namespace fieldcast::image {

namespace {

void check_sizes(const RgbF32& a, const RgbF32& b) {
    FC_ASSERT(a.width_px == b.width_px && a.height_px == b.height_px, "images have one size");
    const std::size_t count = static_cast<std::size_t>(a.width_px) * a.height_px;
    FC_ASSERT(count > 0 && a.pixels.size() == count && b.pixels.size() == count, "images have all their pixels");
}

/// Mean of f(x, r) over pixels and channels.
template <class F> double channel_mean(const RgbF32& image, const RgbF32& reference, F f) {
    check_sizes(image, reference);
    double sum = 0.0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        for (int channel = 0; channel < 3; ++channel) {
            sum += f(static_cast<double>(image.pixels[i][channel]), static_cast<double>(reference.pixels[i][channel]));
        }
    }
    return sum / (3.0 * static_cast<double>(image.pixels.size()));
}

/// One number per pixel.
struct Field {
    std::size_t width = 0;
    std::size_t height = 0;
    std::vector<double> values;
};

Field luma_field(const RgbF32& image) {
    Field field{image.width_px, image.height_px, {}};
    field.values.reserve(image.pixels.size());
    for (const glm::vec3& pixel : image.pixels) {
        field.values.push_back(luma(pixel));
    }
    return field;
}

Field product(const Field& a, const Field& b) {
    Field field = a;
    for (std::size_t i = 0; i < field.values.size(); ++i) {
        field.values[i] *= b.values[i];
    }
    return field;
}

/// Weighted mean over the window around each pixel whose window lies inside: smaller by the radius on each side.
Field window_mean(const Field& field) {
    const SsimTaps& taps = ssim_taps();
    const std::size_t width = field.width - 2 * kSsimRadius;
    Field across{width, field.height, std::vector<double>(width * field.height)};
    for (std::size_t y = 0; y < field.height; ++y) {
        for (std::size_t x = 0; x < width; ++x) {
            for (std::size_t i = 0; i < taps.size(); ++i) {
                across.values[y * width + x] += taps[i] * field.values[y * field.width + x + i];
            }
        }
    }
    const std::size_t height = field.height - 2 * kSsimRadius;
    Field result{width, height, std::vector<double>(width * height)};
    for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t i = 0; i < taps.size(); ++i) {
            for (std::size_t x = 0; x < width; ++x) {
                result.values[y * width + x] += taps[i] * across.values[(y + i) * width + x];
            }
        }
    }
    return result;
}

void check_ssim_sizes(const RgbF32& image, const RgbF32& reference) {
    check_sizes(image, reference);
    FC_ASSERT(image.width_px > 2 * kSsimRadius && image.height_px > 2 * kSsimRadius, "the window fits into the image");
}

/// SSIM of an image and a reference, whose mean square in each window is `mean_yy`.
double mean_ssim(const Field& x, const Field& y, const Field& mean_yy) {
    const Field mean_x = window_mean(x);
    const Field mean_y = window_mean(y);
    const Field mean_xx = window_mean(product(x, x));
    const Field mean_xy = window_mean(product(x, y));
    double sum = 0.0;
    for (std::size_t i = 0; i < mean_x.values.size(); ++i) {
        sum += ssim_of({mean_x.values[i], mean_y.values[i], mean_xx.values[i], mean_yy.values[i], mean_xy.values[i]});
    }
    return sum / static_cast<double>(mean_x.values.size());
}

} // namespace

RgbF32 display_image(const RgbF32& linear, float exposure) {
    RgbF32 result = linear;
    for (glm::vec3& pixel : result.pixels) {
        for (int channel = 0; channel < 3; ++channel) {
            pixel[channel] = srgb_from_linear(exposure * pixel[channel]);
        }
    }
    return result;
}

RgbF32 display_image(const Plane& rgb) {
    FC_ASSERT(rgb.format == PlaneFormat::kRgb8, "plane is display-referred");
    FC_ASSERT(rgb.bytes.size() == plane_bytes(rgb.format, rgb.width_px, rgb.height_px), "plane has all its pixels");
    RgbF32 result{rgb.width_px, rgb.height_px, {}};
    const auto value = [&](std::size_t i) { return static_cast<float>(std::to_integer<int>(rgb.bytes[i])) / 255.0F; };
    for (std::size_t i = 0; i < rgb.bytes.size(); i += 3) {
        result.pixels.emplace_back(value(i), value(i + 1), value(i + 2));
    }
    return result;
}

double rmse(const RgbF32& image, const RgbF32& reference) {
    return std::sqrt(channel_mean(image, reference, [](double x, double r) { return (x - r) * (x - r); }));
}

double psnr_db(const RgbF32& image, const RgbF32& reference) {
    return -20.0 * std::log10(rmse(image, reference)); // log10(0) = −infinity
}

double ssim(const RgbF32& image, const RgbF32& reference) {
    check_ssim_sizes(image, reference);
    const Field y = luma_field(reference);
    return mean_ssim(luma_field(image), y, window_mean(product(y, y)));
}

double rmse_without_noise(const RgbF32& image, const RgbF32& first, const RgbF32& second) {
    check_sizes(image, first);
    check_sizes(image, second);
    double sum = 0.0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const glm::dvec3 pixel(image.pixels[i]);
        sum += glm::dot(pixel - glm::dvec3(first.pixels[i]), pixel - glm::dvec3(second.pixels[i]));
    }
    // Noise can bring a small sum below 0.
    return std::sqrt(std::max(0.0, sum / (3.0 * static_cast<double>(image.pixels.size()))));
}

double ssim_without_noise(const RgbF32& image, const RgbF32& first, const RgbF32& second) {
    check_ssim_sizes(image, first);
    check_ssim_sizes(image, second);
    const Field a = luma_field(first);
    const Field b = luma_field(second);
    Field y = a;
    for (std::size_t i = 0; i < y.values.size(); ++i) {
        y.values[i] = (a.values[i] + b.values[i]) / 2.0;
    }
    const Field mean_a = window_mean(a);
    const Field mean_b = window_mean(b);
    Field mean_yy = window_mean(product(a, b));
    for (std::size_t i = 0; i < mean_yy.values.size(); ++i) {
        const double mean_y = (mean_a.values[i] + mean_b.values[i]) / 2.0;
        const double covariance = mean_yy.values[i] - mean_a.values[i] * mean_b.values[i];
        mean_yy.values[i] = mean_y * mean_y + std::max(0.0, covariance);
    }
    return mean_ssim(luma_field(image), y, mean_yy);
}

double relative_mse(const RgbF32& image, const RgbF32& reference) {
    return channel_mean(image, reference, [](double x, double r) { return (x - r) * (x - r) / (r * r + 0.01); });
}

} // namespace fieldcast::image
