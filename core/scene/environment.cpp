// SPDX-License-Identifier: Apache-2.0
#include "core/scene/environment.h"

#include "core/base/error.h"
#include "core/image/image_file.h"

#include <cmath>

namespace fieldcast::scene {

void check_sky(const glm::vec3& sky) {
    for (int i = 0; i < 3; ++i) {
        if (!std::isfinite(sky[i]) || sky[i] < 0.0F) {
            throw UserError("sky: radiance must be finite and not negative");
        }
    }
}

Environment read_environment(const LoadOptions& options) {
    Environment environment;
    if (!options.environment) {
        check_sky(options.sky);
        environment.constant = options.sky;
        return environment;
    }
    image::RgbF32 image = image::read_rgb_f32(*options.environment, {options.limits.max_image_pixels});
    environment.constant = glm::vec3(0.0F);
    environment.width_px = image.width_px;
    environment.height_px = image.height_px;
    environment.pixels = std::move(image.pixels);
    for (std::size_t i = 0; i < environment.pixels.size(); ++i) {
        glm::vec3& pixel = environment.pixels[i];
        if (!std::isfinite(pixel.x) || !std::isfinite(pixel.y) || !std::isfinite(pixel.z)) {
            throw UserError(options.environment->filename().string() + ": pixel " +
                            std::to_string(i % environment.width_px) + ", " + std::to_string(i / environment.width_px) +
                            " is not finite; save the image without NaN and infinity");
        }
        pixel = glm::max(pixel, glm::vec3(0.0F)); // image resampling can produce small negative values
    }
    return environment;
}

} // namespace fieldcast::scene
