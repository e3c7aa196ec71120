// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/plane.h"

#include <compare>
#include <cstdint>
#include <optional>

namespace fieldcast::codec {

/// How a plane's strips become bytes. Values are on the wire: never renumber.
enum class CodecId : std::uint8_t {
    kRaw = 1,          ///< pixels as they are
    kZstdFiltered = 2, ///< predictor per format, byte planes, zstd level 1; lossless
    kJpeg = 3,         ///< kRgb8, kR11G11B10F: baseline JPEG without subsampling; lossy
    kH264 = 4,         ///< kRgb8: H.264, views predicted from one view of the same frame; lossy
};

/// The codec with that number, or nothing.
std::optional<CodecId> codec_from_number(std::uint64_t number);

bool is_lossy(CodecId codec);

/// Whether planes of that format can be encoded so.
bool fits(CodecId codec, PlaneFormat format);

inline constexpr std::uint8_t kMaxQuality = 100;

/// A codec and how good it shall be.
struct Encoding {
    CodecId codec = CodecId::kZstdFiltered;
    std::uint8_t quality = 0; ///< of lossy codecs 1 (smallest) to kMaxQuality; 0 of others

    auto operator<=>(const Encoding&) const = default;
};

} // namespace fieldcast::codec
