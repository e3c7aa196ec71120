// SPDX-License-Identifier: Apache-2.0
// Follows: M. Levoy, P. Hanrahan. Light Field Rendering. SIGGRAPH 1996; V. Vaish et al. Using Plane + Parallax for
// Calibrating Dense Camera Arrays. CVPR 2004, section 2 (synthetic aperture by shifting and adding).
#include "core/image/refocus.h"

#include "core/base/error.h"
#include "core/image/correspondence.h"

#include <algorithm>

namespace fieldcast::image {

RgbF32 refocus(std::span<const ShiftedView> views) {
    FC_ASSERT(!views.empty(), "a light field has views");
    RgbF32 result{views[0].image->width_px, views[0].image->height_px, {}};
    const glm::vec2 last(static_cast<float>(result.width_px) - 0.5F, static_cast<float>(result.height_px) - 0.5F);
    result.pixels.reserve(views[0].image->pixels.size());
    for (std::uint32_t y = 0; y < result.height_px; ++y) {
        for (std::uint32_t x = 0; x < result.width_px; ++x) {
            const glm::vec2 centre(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
            glm::vec3 sum(0.0F);
            float count = 0.0F;
            for (const ShiftedView& view : views) {
                const glm::vec2 place = centre + view.shift_px;
                if (place.x >= 0.5F && place.y >= 0.5F && place.x <= last.x && place.y <= last.y) {
                    sum += sample_bilinear(*view.image, place);
                    count += 1.0F;
                }
            }
            result.pixels.push_back(sum / std::max(count, 1.0F));
        }
    }
    return result;
}

std::vector<float> focal_depths(std::vector<float> depth_m, std::size_t count) {
    FC_ASSERT(!depth_m.empty() && count >= 2, "depths to choose from, and at least two of them");
    std::ranges::sort(depth_m, std::greater<>()); // inverse depths, ascending
    const auto inverse_quantile = [&](double share) {
        return 1.0F / depth_m[static_cast<std::size_t>(share * static_cast<double>(depth_m.size() - 1) + 0.5)];
    };
    const float farthest = inverse_quantile(0.05);
    const float nearest = inverse_quantile(0.95);
    std::vector<float> result;
    for (std::size_t i = 0; i < count; ++i) {
        const float share = static_cast<float>(i) / static_cast<float>(count - 1);
        result.push_back(1.0F / (farthest + share * (nearest - farthest)));
    }
    return result;
}

} // namespace fieldcast::image
