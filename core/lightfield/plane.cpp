// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/plane.h"

namespace fieldcast {

std::uint32_t bytes_per_pixel(PlaneFormat format) {
    return row_of(format).bytes_per_pixel;
}

std::uint64_t plane_bytes(PlaneFormat format, std::uint32_t width_px, std::uint32_t height_px) {
    return static_cast<std::uint64_t>(bytes_per_pixel(format)) * width_px * height_px;
}

} // namespace fieldcast
