// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/plane.h"

namespace fieldcast {

std::uint32_t bytes_per_pixel(PlaneFormat format) {
    switch (format) {
    case PlaneFormat::kR11G11B10F:
    case PlaneFormat::kF32:
    case PlaneFormat::kOct2x16:
    case PlaneFormat::kU32:
        return 4;
    case PlaneFormat::kRg8:
    case PlaneFormat::kR16:
    case PlaneFormat::kOct2x8:
        return 2;
    case PlaneFormat::kRgb8:
        return 3;
    }
    return 0;
}

std::uint64_t plane_bytes(PlaneFormat format, std::uint32_t width_px, std::uint32_t height_px) {
    return static_cast<std::uint64_t>(bytes_per_pixel(format)) * width_px * height_px;
}

} // namespace fieldcast
