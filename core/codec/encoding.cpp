// SPDX-License-Identifier: Apache-2.0
#include "core/codec/encoding.h"

namespace fieldcast::codec {

std::optional<CodecId> codec_from_number(std::uint64_t number) {
    switch (static_cast<CodecId>(number)) {
    case CodecId::kRaw:
    case CodecId::kZstdFiltered:
    case CodecId::kJpeg:
    case CodecId::kH264:
        return number <= 0xFF ? std::optional(static_cast<CodecId>(number)) : std::nullopt;
    }
    return std::nullopt;
}

bool is_lossy(CodecId codec) {
    return codec == CodecId::kJpeg || codec == CodecId::kH264;
}

bool fits(CodecId codec, PlaneFormat format) {
    const bool is_light = format == PlaneFormat::kR11G11B10F;
    return !is_lossy(codec) || format == PlaneFormat::kRgb8 || (is_light && codec == CodecId::kJpeg);
}

} // namespace fieldcast::codec
