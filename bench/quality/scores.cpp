// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/scores.h"

#include "core/base/error.h"
#include "core/image/metrics.h"

#include <algorithm>
#include <cmath>

namespace fieldcast::bench {

namespace {

constexpr std::uint32_t kBorder = 32;

image::RgbF32 exposed(image::RgbF32 image, float exposure) {
    for (glm::vec3& pixel : image.pixels) {
        pixel *= exposure;
    }
    return image;
}

} // namespace

Spread spread_of(const std::vector<double>& values) {
    FC_ASSERT(!values.empty(), "there are values");
    const auto count = static_cast<double>(values.size());
    Spread spread;
    spread.min = *std::ranges::min_element(values);
    spread.max = *std::ranges::max_element(values);
    for (const double value : values) {
        spread.mean += value / count;
    }
    double variance = 0.0;
    for (const double value : values) {
        variance += (value - spread.mean) * (value - spread.mean) / count;
    }
    spread.deviation = std::sqrt(variance);
    return spread;
}

nlohmann::ordered_json Scores::Part::rmse() const {
    return pixels > 0.0 ? nlohmann::ordered_json(std::sqrt(squared / (3.0 * pixels))) : nlohmann::ordered_json();
}

void Scores::add(const PictureId& id, const image::RgbF32& linear, const ReferencePicture& reference, float exposure,
                 const PictureMasks& masks) {
    const image::RgbF32 shown = image::display_image(linear, exposure);
    const image::RgbF32 expected = image::display_image(reference.mean, exposure);
    const image::RgbF32 first = image::display_image(reference.halves[0], exposure);
    const image::RgbF32 second = image::display_image(reference.halves[1], exposure);
    // The constant 0.01 of relative errors needs a scale, which is the exposure.
    pictures_.push_back({id, image::rmse(shown, expected), image::ssim(shown, expected),
                         image::rmse_without_noise(shown, first, second),
                         image::ssim_without_noise(shown, first, second),
                         image::relative_mse(exposed(linear, exposure), exposed(reference.mean, exposure))});
    for (std::size_t i = 0; i < shown.pixels.size(); ++i) {
        const glm::dvec3 difference = glm::dvec3(shown.pixels[i]) - glm::dvec3(expected.pixels[i]);
        const double squared = glm::dot(difference, difference);
        const auto add_to = [&](Part& part, bool is_in) {
            part.squared += is_in ? squared : 0.0;
            part.pixels += is_in ? 1.0 : 0.0;
        };
        const bool is_hole = !masks.holes.empty() && masks.holes[i];
        add_to(holes_, is_hole);
        add_to(reused_, !is_hole);
        add_to(moving_, !masks.moving.empty() && masks.moving[i]);
        const auto x = static_cast<std::uint32_t>(i) % shown.width_px;
        const auto y = static_cast<std::uint32_t>(i) / shown.width_px;
        add_to(border_, std::min({x, y, shown.width_px - 1 - x, shown.height_px - 1 - y}) < kBorder);
    }
}

nlohmann::ordered_json Scores::to_json() const {
    const auto mean = [&](double PictureScore::*value) -> nlohmann::ordered_json {
        std::vector<double> values;
        for (const PictureScore& picture : pictures_) {
            values.push_back(picture.*value);
        }
        return values.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(spread_of(values).mean);
    };
    return {{"rmse", mean(&PictureScore::rmse)},
            {"ssim", mean(&PictureScore::ssim)},
            {"rmse_without_noise", mean(&PictureScore::rmse_without_noise)},
            {"ssim_without_noise", mean(&PictureScore::ssim_without_noise)},
            {"relative_mse", mean(&PictureScore::relative_mse)},
            {"rmse_holes", holes_.rmse()},
            {"rmse_reused", reused_.rmse()},
            {"rmse_border", border_.rmse()},
            {"rmse_moving", moving_.rmse()}};
}

} // namespace fieldcast::bench
