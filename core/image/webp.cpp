// SPDX-License-Identifier: Apache-2.0
#include "core/image/webp.h"

#include <webp/decode.h>

namespace fieldcast::image {

Decoded<Rgba8> decode_webp(std::span<const std::byte> bytes, const ImageHeader& header) {
    const auto* const data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(data, bytes.size(), &features) != VP8_STATUS_OK) {
        return decode_error("damaged WebP header");
    }
    if (features.has_animation != 0) {
        return decode_error("animated WebP is not supported");
    }
    if (features.width != static_cast<int>(header.width_px) || features.height != static_cast<int>(header.height_px)) {
        return decode_error("contradictory WebP headers");
    }
    Rgba8 image{header.width_px, header.height_px, {}};
    image.pixels.resize(std::size_t{4} * image.width_px * image.height_px);
    if (WebPDecodeRGBAInto(data, bytes.size(), image.pixels.data(), image.pixels.size(), features.width * 4) ==
        nullptr) {
        return decode_error("damaged WebP image");
    }
    return image;
}

} // namespace fieldcast::image
