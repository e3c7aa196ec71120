// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace fieldcast::image {

/// 8 bits per channel, not premultiplied, in the file's own transfer function.
struct Rgba8 {
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    std::vector<std::uint8_t> pixels; ///< 4 bytes per pixel, row 0 on top
};

} // namespace fieldcast::image
