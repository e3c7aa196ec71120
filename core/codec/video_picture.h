// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/codec/jpeg.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fieldcast::codec {

/// 8-bit Y'CbCr of Rec. 709 in video range (Y' 16 to 235); Cb and Cr have one sample per 2×2 pixels, in their middle.
/// Sides are even and at least 16: the last row and column are repeated as often as necessary.
struct VideoPicture {
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    std::vector<std::uint8_t> luma;
    std::vector<std::uint8_t> blue; ///< Cb
    std::vector<std::uint8_t> red;  ///< Cr
};

/// The size of the picture that holds an image.
std::uint32_t video_side(std::uint32_t side_px);

VideoPicture video_from_rgb(std::span<const std::byte> rgb, RgbSize size);

/// One channel of a picture that another object owns.
struct VideoChannel {
    const std::uint8_t* samples = nullptr;
    std::size_t stride = 0;
};

/// Fills `rgb` of size.bytes(). The channels are those of a picture of that size; Cb and Cr are interpolated.
void rgb_from_video(VideoChannel luma, VideoChannel blue, VideoChannel red, RgbSize size, std::span<std::byte> rgb);

} // namespace fieldcast::codec
