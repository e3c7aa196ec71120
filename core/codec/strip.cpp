// SPDX-License-Identifier: Apache-2.0
#include "core/codec/strip.h"

#include <optional>
#include <string>

namespace fieldcast::codec {

namespace {

constexpr std::uint8_t kStripVersion = 1;
constexpr std::uint8_t kFoldedFlag = 1;    ///< of ZSTD_FILTERED
constexpr std::uint8_t kPredictedFlag = 1; ///< of H264

void put_u16(std::byte* at, std::uint32_t value) {
    at[0] = static_cast<std::byte>(value);
    at[1] = static_cast<std::byte>(value >> 8);
}

std::uint32_t get_u16(const std::byte* at) {
    return std::to_integer<std::uint32_t>(at[0]) | std::to_integer<std::uint32_t>(at[1]) << 8;
}

std::optional<StripCoding> coding_from_number(std::uint8_t number) {
    const auto coding = static_cast<StripCoding>(number);
    switch (coding) {
    case StripCoding::kRaw:
    case StripCoding::kZstdFiltered:
    case StripCoding::kJpeg:
    case StripCoding::kH264:
    case StripCoding::kRepeat:
        return coding;
    }
    return std::nullopt;
}

std::uint8_t known_flags(StripCoding coding) {
    switch (coding) {
    case StripCoding::kZstdFiltered:
        return kFoldedFlag;
    case StripCoding::kH264:
        return kPredictedFlag;
    case StripCoding::kRaw:
    case StripCoding::kJpeg:
    case StripCoding::kRepeat:
        break;
    }
    return 0;
}

Decoded<ByteFilter> read_filter(StripCoding coding, PlaneFormat format, std::span<const std::byte> strip) {
    const auto predictor = std::to_integer<std::uint8_t>(strip[3]);
    const auto layout = std::to_integer<std::uint8_t>(strip[4]);
    const auto flags = std::to_integer<std::uint8_t>(strip[5]);
    if (flags > known_flags(coding)) {
        return decode_error("strip header: unknown flags");
    }
    if (coding != StripCoding::kZstdFiltered) {
        if (predictor != 0 || layout != 0) {
            return decode_error("strip header: only ZSTD_FILTERED has a filter");
        }
        return ByteFilter{};
    }
    const auto filter = filter_from_numbers(format, predictor, layout, flags != 0);
    if (!filter) {
        return decode_error("strip header: predictor " + std::to_string(predictor) + " on channels of layout " +
                            std::to_string(layout) + " does not fit the format");
    }
    return *filter;
}

} // namespace

std::optional<Codec> codec_of(StripCoding coding) {
    switch (coding) {
    case StripCoding::kZstdFiltered:
        return Codec::kZstdFiltered;
    case StripCoding::kJpeg:
        return Codec::kJpeg;
    case StripCoding::kH264:
        return Codec::kH264;
    case StripCoding::kRaw:
    case StripCoding::kRepeat:
        break;
    }
    return std::nullopt;
}

bool StripHeader::needs_reference() const {
    return coding == StripCoding::kRepeat ||
           (coding == StripCoding::kZstdFiltered && filter.predictor == Predictor::kReference);
}

void write_header(StripHeader header, std::vector<std::byte>& strip) {
    const bool has_filter = header.coding == StripCoding::kZstdFiltered;
    header.body_bytes = static_cast<std::uint32_t>(strip.size() - kStripHeaderBytes);
    strip[0] = std::byte{kStripVersion};
    strip[1] = static_cast<std::byte>(header.coding);
    strip[2] = static_cast<std::byte>(header.format);
    strip[3] = has_filter ? static_cast<std::byte>(header.filter.predictor) : std::byte{0};
    strip[4] = has_filter ? static_cast<std::byte>(header.filter.layout) : std::byte{0};
    strip[5] = has_filter && header.filter.is_folded ? std::byte{kFoldedFlag} : std::byte{0};
    if (header.coding == StripCoding::kH264 && header.is_predicted) {
        strip[5] = std::byte{kPredictedFlag};
    }
    put_u16(&strip[6], header.width_px);
    put_u16(&strip[8], header.band.first_row);
    put_u16(&strip[10], header.band.row_count);
    put_u16(&strip[12], header.body_bytes & 0xFFFF);
    put_u16(&strip[14], header.body_bytes >> 16);
}

Decoded<StripHeader> read_header(std::span<const std::byte> strip) {
    if (strip.size() < kStripHeaderBytes) {
        return decode_error("strip: " + std::to_string(strip.size()) + " bytes, the header has 16");
    }
    if (strip[0] != std::byte{kStripVersion}) {
        return decode_error("strip header: version " + std::to_string(std::to_integer<int>(strip[0])) + " is not 1");
    }
    const auto coding = coding_from_number(std::to_integer<std::uint8_t>(strip[1]));
    const auto format = static_cast<PlaneFormat>(strip[2]);
    if (!coding || bytes_per_pixel(format) == 0) {
        return decode_error("strip header: unknown codec or format");
    }
    const auto filter = read_filter(*coding, format, strip);
    if (!filter) {
        return tl::unexpected(filter.error());
    }
    StripHeader header{.coding = *coding,
                       .format = format,
                       .filter = *filter,
                       .is_predicted = *coding == StripCoding::kH264 && strip[5] == std::byte{kPredictedFlag},
                       .width_px = get_u16(&strip[6]),
                       .band = {get_u16(&strip[8]), get_u16(&strip[10])}};
    header.body_bytes = get_u16(&strip[12]) | get_u16(&strip[14]) << 16;
    if (header.body_bytes != strip.size() - kStripHeaderBytes) {
        return decode_error("strip header: says " + std::to_string(header.body_bytes) + " bytes follow, there are " +
                            std::to_string(strip.size() - kStripHeaderBytes));
    }
    return header;
}

} // namespace fieldcast::codec
