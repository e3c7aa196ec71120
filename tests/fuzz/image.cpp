// SPDX-License-Identifier: Apache-2.0
#include "core/image/image_file.h"

#include "core/base/error.h"
#include "tests/fuzz/input.h"

namespace fieldcast::fuzz {

void image(Bytes input) {
    constexpr image::ImageLimits kLimits{.max_pixels = 1U << 16};
    is_refused([&] {
        const image::Rgba8 image = image::decode_rgba8(input, "input", kLimits);
        const std::uint64_t pixels = std::uint64_t{image.width_px} * image.height_px;
        FC_ASSERT(pixels > 0 && pixels <= kLimits.max_pixels, "no more pixels than the limit");
        FC_ASSERT(image.pixels.size() == 4 * pixels, "an image has all its pixels");
    });
}

} // namespace fieldcast::fuzz
