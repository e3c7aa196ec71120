// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/plane.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

// Reversible filters that make planes compressible. Part of the wire format: docs/protocol.md, "Strips".
namespace fieldcast::codec {

/// Prediction of a value from its neighbours in the same channel. Values are on the wire: never renumber.
enum class Predictor : std::uint8_t {
    kNone = 0,
    kLeft = 1,      ///< left
    kGradient = 2,  ///< left + up − up-left
    kAverage = 3,   ///< ⌊(left + up) / 2⌋
    kReference = 4, ///< the same place in the reference plane
};

/// Conversion of a pixel into channels. Values are on the wire: never renumber.
enum class Layout : std::uint8_t {
    kBytes = 1,        ///< a channel per byte
    kWords16 = 2,      ///< a channel per little-endian 16-bit word
    kGreenBytes = 3,   ///< kRgb8: green, red − green + 128, blue − green + 128
    kWords32 = 4,      ///< one channel, a little-endian 32-bit word
    kPackedFloats = 11 ///< kR11G11B10F: the three floats' bits; green, red − green, blue − green / 2, centred
};

struct ByteFilter {
    Predictor predictor = Predictor::kNone;
    Layout layout = Layout::kBytes;
    bool is_folded = false; ///< errors 0, −1, 1, −2 … become 0, 1, 2, 3 …: high bytes of small errors are 0

    bool operator==(const ByteFilter&) const = default;
};

/// The filter that the encoder uses for that format, if it does not refer to another plane.
ByteFilter filter_for(PlaneFormat format);

/// The filter with those numbers if it can be applied to `format`, or nothing.
std::optional<ByteFilter> filter_from_numbers(PlaneFormat format, std::uint8_t predictor, std::uint8_t layout,
                                              bool is_folded);

/// Size of a band of pixels.
struct BandSize {
    std::uint32_t width_px = 0;
    std::uint32_t row_count = 0;
    std::uint32_t pixel_bytes = 0;

    std::size_t bytes() const { return std::size_t{width_px} * row_count * pixel_bytes; }
};

/// Pixels → byte planes of prediction errors. Neighbours outside the band do not exist. All spans have size.bytes();
/// `reference` is empty unless the predictor is kReference.
void filter_band(ByteFilter filter, BandSize size, std::span<const std::byte> pixels,
                 std::span<const std::byte> reference, std::span<std::byte> filtered);

/// The inverse of `filter_band`.
void unfilter_band(ByteFilter filter, BandSize size, std::span<const std::byte> filtered,
                   std::span<const std::byte> reference, std::span<std::byte> pixels);

/// Bits that the errors of every eighth row need, roughly: compares filters of one band without compressing.
std::uint64_t filter_cost(ByteFilter filter, BandSize size, std::span<const std::byte> pixels,
                          std::span<const std::byte> reference);

} // namespace fieldcast::codec
