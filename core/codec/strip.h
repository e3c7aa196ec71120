// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "core/codec/byte_filter.h"
#include "core/lightfield/vocabulary.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace fieldcast::codec {

/// Content of the bytes of one strip. Values are on the wire: never renumber.
enum class StripCoding : std::uint8_t {
    kRaw = 1,          ///< pixels as they are
    kZstdFiltered = 2, ///< byte planes of prediction errors in a zstd frame
    kJpeg = 3,         ///< a JPEG file
    kH264 = 4,         ///< an H.264 byte stream of one picture
    kRepeat = 5,       ///< no bytes: the pixels of the reference
};

/// The codec that makes such strips; empty if every codec may.
std::optional<Codec> codec_of(StripCoding coding);

/// A band of rows of a plane.
struct RowBand {
    std::uint32_t first_row = 0;
    std::uint32_t row_count = 0;

    bool operator==(const RowBand&) const = default;
};

inline constexpr std::size_t kStripHeaderBytes = 16;

/// The first kStripHeaderBytes bytes of a strip; docs/protocol.md has the layout.
struct StripHeader {
    StripCoding coding = StripCoding::kRaw;
    PlaneFormat format = PlaneFormat::kRgb8;
    ByteFilter filter{};       ///< of kZstdFiltered
    bool is_predicted = false; ///< of kH264: from the strip of the same rows of the base view
    std::uint32_t width_px = 0;
    RowBand band{};
    std::uint32_t body_bytes = 0;

    /// The strip cannot be decoded without the reference plane.
    bool needs_reference() const;
};

/// Overwrites the header at the beginning of `strip`, whose body is complete; fills in `body_bytes`.
void write_header(StripHeader header, std::vector<std::byte>& strip);

/// Reads and checks the header; afterwards the body has `body_bytes` bytes.
Decoded<StripHeader> read_header(std::span<const std::byte> strip);

} // namespace fieldcast::codec
