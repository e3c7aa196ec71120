// SPDX-License-Identifier: Apache-2.0
#include "core/scene/environment.h"

#include "core/base/error.h"
#include "tests/fuzz/input.h"

#include <cmath>

namespace fieldcast::fuzz {

void environment(Bytes input) {
    constexpr std::string_view kExr = "\x76\x2f\x31\x01";
    scene::LoadOptions options;
    options.limits.max_image_pixels = 1U << 16;
    options.environment = scratch_file(as_text(input).starts_with(kExr) ? "sky.exr" : "sky.hdr", input);
    is_refused([&] {
        const scene::Environment sky = scene::read_environment(options);
        const std::uint64_t pixels = std::uint64_t{sky.width_px} * sky.height_px;
        FC_ASSERT(pixels <= options.limits.max_image_pixels, "no more pixels than the limit");
        FC_ASSERT(sky.pixels.size() == pixels, "an image has all its pixels");
        for (const glm::vec3& pixel : sky.pixels) {
            for (int channel = 0; channel < 3; ++channel) {
                FC_ASSERT(std::isfinite(pixel[channel]) && pixel[channel] >= 0.0F, "light is finite and not negative");
            }
        }
    });
}

} // namespace fieldcast::fuzz
