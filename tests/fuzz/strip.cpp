// SPDX-License-Identifier: Apache-2.0
// An input is a strip, as in tests/data/wire. The planes around it have the size that its header claims, and the codec
// that it is in, so that damage reaches the decoders.
#include "core/codec/plane_codec.h"
#include "tests/fuzz/input.h"

#include <algorithm>

namespace fieldcast::fuzz {

namespace {

constexpr std::uint64_t kMaxBytes = 1U << 20; ///< of a plane; larger ones are only slower

/// Other bytes than zero, so that what is copied from a reference is seen.
void fill(Plane& plane) {
    for (std::size_t i = 0; i < plane.bytes.size(); ++i) {
        plane.bytes[i] = static_cast<std::byte>(i * 7);
    }
}

void expect_only_band_changed(const Plane& plane, codec::RowBand band, std::byte before) {
    const std::size_t row_bytes = plane.bytes.size() / plane.height_px;
    const auto is_same = [&](std::byte byte) { return byte == before; };
    const auto above = std::span(plane.bytes).first(band.first_row * row_bytes);
    const auto below = std::span(plane.bytes).subspan((band.first_row + band.row_count) * row_bytes);
    FC_ASSERT(std::ranges::all_of(above, is_same) && std::ranges::all_of(below, is_same), "rows outside the band");
}

void decode(Bytes input, const codec::StripHeader& header, Codec codec, Plane& plane) {
    constexpr std::byte kBefore{0x5A};
    Plane reference = plane;
    fill(reference);
    std::vector<std::byte> base;
    if (header.is_predicted && plane.format == PlaneFormat::kRgb8) {
        base = codec::encode_strip(reference, header.band, {.encoding = {Codec::kH264, 75}});
    }
    for (const Plane* const known : {static_cast<const Plane*>(nullptr), static_cast<const Plane*>(&reference)}) {
        std::ranges::fill(plane.bytes, kBefore);
        const auto result = codec::decode_strip(input, header.band, {codec, known, base}, plane);
        FC_ASSERT(result || !result.error().message.empty(), "an error says what is wrong");
        FC_ASSERT(!result || known != nullptr || !header.needs_reference(), "there is nothing to refer to");
        expect_only_band_changed(plane, header.band, kBefore);
    }
}

} // namespace

void strip(Bytes input) {
    const auto header = codec::read_header(input);
    if (!header) {
        FC_ASSERT(!header.error().message.empty(), "an error says what is wrong");
        return;
    }
    const std::uint32_t height_px = header->band.first_row + header->band.row_count + 1;
    if (header->width_px == 0 || plane_bytes(header->format, header->width_px, height_px) > kMaxBytes) {
        return;
    }
    auto plane = codec::allocate_plane(PlaneSemantic::kColour, header->format, header->width_px, height_px);
    if (!plane || header->band.row_count == 0) {
        return;
    }
    decode(input, *header, Codec::kZstdFiltered, *plane);
    if (header->coding == codec::StripCoding::kJpeg) {
        decode(input, *header, Codec::kJpeg, *plane);
    }
    if (header->coding == codec::StripCoding::kH264 && plane->format == PlaneFormat::kRgb8) {
        decode(input, *header, Codec::kH264, *plane);
    }
}

} // namespace fieldcast::fuzz
