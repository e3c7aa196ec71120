// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace fieldcast::codec {

enum class H264Picture : std::uint8_t {
    kAlone,     ///< a sequence and a picture parameter set, then the slices of one IDR picture
    kPredicted, ///< slices of one picture, without parameter sets
};

/// Checks a byte stream (annex B) before a decoder sees it. It must consist of exactly one picture of that kind, and
/// parameter sets that ask for no more than one frame of width_px × height_px, 4:2:0, 8 bits, one slice group.
Decoded<void> check_h264_stream(std::span<const std::byte> stream, H264Picture kind, std::uint32_t width_px,
                                std::uint32_t height_px);

} // namespace fieldcast::codec
