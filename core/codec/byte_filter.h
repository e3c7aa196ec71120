// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/plane.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

// Reversible filters that make planes compressible. Part of the wire format: docs/protocol.md, "Strips".
namespace fieldcast::codec {

/// How a word is predicted from its neighbours in the same channel. Values are on the wire: never renumber.
enum class Predictor : std::uint8_t {
    kNone = 0,
    kLeft = 1,     ///< left
    kGradient = 2, ///< left + up − up-left
};

/// Words are little-endian and differences wrap; a pixel is bytes_per_pixel / word_bytes channels of one word.
struct ByteFilter {
    Predictor predictor = Predictor::kNone;
    std::uint8_t word_bytes = 1;

    bool operator==(const ByteFilter&) const = default;
};

/// The filter our encoder uses for that format.
ByteFilter filter_for(PlaneFormat format);

/// The filter with those numbers if it can be applied to `format`, or nothing.
std::optional<ByteFilter> filter_from_numbers(PlaneFormat format, std::uint8_t predictor, std::uint8_t word_bytes);

/// Size of a band of pixels.
struct BandSize {
    std::uint32_t width_px = 0;
    std::uint32_t row_count = 0;
    std::uint32_t pixel_bytes = 0;

    std::size_t bytes() const { return std::size_t{width_px} * row_count * pixel_bytes; }
};

/// Pixels → byte planes of prediction errors: byte b of pixel i goes to `filtered[b · pixels + i]`.
/// Neighbours outside the band count as 0. Both spans have size.bytes().
void filter_band(ByteFilter filter, BandSize size, std::span<const std::byte> pixels, std::span<std::byte> filtered);

/// The inverse of `filter_band`.
void unfilter_band(ByteFilter filter, BandSize size, std::span<const std::byte> filtered, std::span<std::byte> pixels);

} // namespace fieldcast::codec
