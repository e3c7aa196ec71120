// SPDX-License-Identifier: Apache-2.0
#include "bench/scores.h"

#include "core/image/metrics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fieldcast::bench {

namespace {

constexpr std::uint32_t kBorder = 32;

double mean(const std::vector<double>& values) {
    return values.empty() ? 0.0 : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

} // namespace

double Scores::Part::rmse() const {
    return pixels > 0.0 ? std::sqrt(squared / (3.0 * pixels)) : 0.0;
}

void Scores::add(const image::RgbF32& linear, const image::RgbF32& reference, float exposure,
                 const std::vector<bool>& hole_mask) {
    const image::RgbF32 shown = image::display_image(linear, exposure);
    const image::RgbF32 expected = image::display_image(reference, exposure);
    rmse_.push_back(image::rmse(shown, expected));
    ssim_.push_back(image::ssim(shown, expected));
    image::RgbF32 exposed = linear; // relative errors need a scale for their 0.01
    image::RgbF32 exposed_reference = reference;
    for (std::size_t i = 0; i < exposed.pixels.size(); ++i) {
        exposed.pixels[i] *= exposure;
        exposed_reference.pixels[i] *= exposure;
    }
    relative_mse_.push_back(image::relative_mse(exposed, exposed_reference));
    for (std::size_t i = 0; i < shown.pixels.size(); ++i) {
        const glm::dvec3 difference = glm::dvec3(shown.pixels[i]) - glm::dvec3(expected.pixels[i]);
        const double squared = glm::dot(difference, difference);
        const auto add_to = [&](Part& part) {
            part.squared += squared;
            part.pixels += 1.0;
        };
        add_to(!hole_mask.empty() && hole_mask[i] ? holes_ : reused_);
        const auto x = static_cast<std::uint32_t>(i) % shown.width_px;
        const auto y = static_cast<std::uint32_t>(i) / shown.width_px;
        if (std::min({x, y, shown.width_px - 1 - x, shown.height_px - 1 - y}) < kBorder) {
            add_to(border_);
        }
    }
}

nlohmann::ordered_json Scores::to_json() const {
    return {{"rmse", mean(rmse_)},           {"ssim", mean(ssim_)},
            {"relative_mse", mean(relative_mse_)}, {"rmse_holes", holes_.rmse()},
            {"rmse_reused", reused_.rmse()}, {"rmse_border", border_.rmse()}};
}

} // namespace fieldcast::bench
