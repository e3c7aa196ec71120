// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "core/codec/jpeg.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Pictures as H.264 (ITU-T H.264), by OpenH264: 8-bit Y'CbCr 4:2:0 of Rec. 709 in video range. A picture stands alone,
// or is predicted from one other picture, its base: another view of the same frame. Calls share no state, so every
// receiver that has the base can decode a predicted picture.
namespace fieldcast::codec {

/// A picture by itself: parameter sets and an IDR picture, as a byte stream (annex B). `rgb` has size.bytes();
/// `quality` is 1 (smallest) to 100. Throws std::runtime_error if the library cannot encode the size (kMaxH264Side).
std::vector<std::byte> encode_h264(std::span<const std::byte> rgb, RgbSize size, std::uint8_t quality);

/// One picture that is predicted from the base; decoders need it after `encode_h264(base, size, quality)`.
std::vector<std::byte> encode_h264_from(std::span<const std::byte> base, std::span<const std::byte> rgb, RgbSize size,
                                        std::uint8_t quality);

/// Fills `rgb`, which has size.bytes(). `base` is the base as `encode_h264` returned it; empty: `picture` stands alone.
/// Both must be of exactly that size, with nothing but the one picture in it; the library sees nothing else. On failure
/// `rgb` is undefined. Memory: a few pictures of that size.
Decoded<void> decode_h264(std::span<const std::byte> base, std::span<const std::byte> picture, RgbSize size,
                          std::span<std::byte> rgb);

inline constexpr std::uint32_t kMaxH264Side = 4096; ///< of level 5.1; decoders need not support larger pictures

} // namespace fieldcast::codec
