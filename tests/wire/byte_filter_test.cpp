// SPDX-License-Identifier: Apache-2.0
#include "core/codec/byte_filter.h"

#include "tests/wire/test_planes.h"

#include <cstring>
#include <gtest/gtest.h>

namespace fieldcast::codec {
namespace {

using namespace fieldcast::testing;

std::vector<ByteFilter> filters_of(PlaneFormat format) {
    std::vector<ByteFilter> filters;
    for (unsigned predictor = 0; predictor <= 5; ++predictor) {
        for (unsigned layout = 0; layout <= 12; ++layout) {
            for (const bool is_folded : {false, true}) {
                const auto filter = filter_from_numbers(format, static_cast<std::uint8_t>(predictor),
                                                        static_cast<std::uint8_t>(layout), is_folded);
                if (filter) {
                    filters.push_back(*filter);
                }
            }
        }
    }
    return filters;
}

BandSize size_of(const Plane& plane) {
    return {plane.width_px, plane.height_px, bytes_per_pixel(plane.format)};
}

std::vector<std::byte> filtered(ByteFilter filter, const Plane& plane, const Plane& other) {
    std::vector<std::byte> result(plane.bytes.size());
    const bool refers = filter.predictor == Predictor::kReference;
    filter_band(filter, size_of(plane), plane.bytes, refers ? std::span(other.bytes) : std::span<const std::byte>(),
                result);
    return result;
}

TEST(ByteFilter, EveryCombinationThatFitsIsReversible) {
    for (const PlaneFormat format : kAllFormats) {
        const auto filters = filters_of(format);
        // Five predictors, folded or not, times the layouts: bytes, and words or fields where the pixel has such.
        const std::size_t layouts = format == PlaneFormat::kR11G11B10F ? 4 : bytes_per_pixel(format) == 4 ? 3 : 2;
        EXPECT_EQ(filters.size(), 10 * layouts) << name_of(format);
        for (const ByteFilter filter : filters) {
            for (const auto& [width, height] : {std::pair(1U, 1U), std::pair(1U, 5U), std::pair(37U, 9U)}) {
                const Plane plane = random_plane(format, width, height, 3);
                const Plane other = random_plane(format, width, height, 4);
                const auto bytes = filtered(filter, plane, other);
                std::vector<std::byte> restored(bytes.size());
                const bool refers = filter.predictor == Predictor::kReference;
                unfilter_band(filter, size_of(plane), bytes,
                              refers ? std::span(other.bytes) : std::span<const std::byte>(), restored);
                EXPECT_EQ(restored, plane.bytes)
                    << name_of(format) << " predictor " << static_cast<int>(filter.predictor) << " layout "
                    << static_cast<int>(filter.layout) << (filter.is_folded ? " folded " : " ") << width << "x"
                    << height;
            }
        }
    }
}

TEST(ByteFilter, AnyBytesCanBeUnfiltered) { // what arrives need not have been made by filter_band
    for (const PlaneFormat format : kAllFormats) {
        const Plane noise = random_plane(format, 37, 9, 5);
        for (const ByteFilter filter : filters_of(format)) {
            std::vector<std::byte> restored(noise.bytes.size());
            const bool refers = filter.predictor == Predictor::kReference;
            unfilter_band(filter, size_of(noise), noise.bytes,
                          refers ? std::span(noise.bytes) : std::span<const std::byte>(), restored);
            Plane plane = noise;
            plane.bytes = restored;
            EXPECT_EQ(filtered(filter, plane, noise), noise.bytes) << name_of(format);
        }
    }
}

Plane packed_floats(const std::vector<std::uint32_t>& pixels, std::uint32_t width) {
    Plane plane = empty_plane(PlaneFormat::kR11G11B10F, width, static_cast<std::uint32_t>(pixels.size()) / width);
    std::memcpy(plane.bytes.data(), pixels.data(), plane.bytes.size());
    return plane;
}

// The example of docs/protocol.md: grey 1.0 above grey 1.0 and a slightly brighter, redder one.
TEST(ByteFilter, PackedFloatsExample) {
    const std::uint32_t one = 0x3C0 | 0x3C0 << 11 | 0x1E0U << 22; // 1.0 in all three floats
    const std::uint32_t redder = 0x3C4 | 0x3C2 << 11 | 0x1E1U << 22;
    const Plane plane = packed_floats({one, one, one, redder}, 2);
    const auto bytes = filtered({Predictor::kAverage, Layout::kPackedFloats, true}, plane, plane);
    // Channels of grey 1.0: 0x3C0, 0x400, 0x200. The first pixel's folded errors are 2 · 0x3C0 = 0x780, its red error
    // 0x400 is −0x400: 0x7FF, its blue one −0x200: 0x3FF. The last pixel: +2, +2, 0 in green, red, blue.
    const std::vector<std::uint8_t> expected{0x80, 0, 0, 4, 0xFF, 0, 0, 4, 0xFF, 0, 0, 0, 7 | 7 << 3 | 3 << 6, 0, 0, 0};
    ASSERT_EQ(bytes.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(std::to_integer<int>(bytes[i]), expected[i]) << i;
    }
}

TEST(ByteFilter, GreyIsConstantRelativeToGreen) {
    Plane grey = empty_plane(PlaneFormat::kRgb8, 64, 4);
    for (std::size_t i = 0; i < grey.bytes.size(); ++i) {
        grey.bytes[i] = static_cast<std::byte>(i / 3 * 11);
    }
    const auto bytes = filtered({Predictor::kNone, Layout::kGreenBytes, false}, grey, grey);
    for (std::size_t i = 64 * 4; i < bytes.size(); ++i) {
        ASSERT_EQ(bytes[i], std::byte{128}) << i;
    }
}

TEST(ByteFilter, FoldingClearsTheHighBytesOfSmallErrors) {
    Plane plane = empty_plane(PlaneFormat::kOct2x16, 32, 8);
    for (std::size_t i = 0; i < 32 * 8; ++i) { // both words go up and down by one
        const auto word = static_cast<std::uint16_t>(1000 + (i * 2654435761U >> 16) % 3);
        std::memcpy(&plane.bytes[4 * i], &word, 2);
        std::memcpy(&plane.bytes[4 * i + 2], &word, 2);
    }
    const auto folded = filtered({Predictor::kGradient, Layout::kWords16, true}, plane, plane);
    const std::size_t pixels = 32 * 8;
    for (std::size_t i = 1; i < pixels; ++i) {
        ASSERT_EQ(folded[pixels + i], std::byte{0}) << "high bytes of the first word, " << i;
        ASSERT_EQ(folded[3 * pixels + i], std::byte{0}) << "high bytes of the second word, " << i;
    }
}

TEST(ByteFilter, CostTellsWhichFilterIsCheaper) {
    for (const PlaneFormat format : kAllFormats) {
        const Plane plane = random_plane(format, 64, 40, 6);
        Plane near = plane; // differs in a bit here and there: the reference predicts it, neighbours do not
        for (std::size_t i = 0; i < near.bytes.size(); i += 16) {
            near.bytes[i] ^= std::byte{1};
        }
        ByteFilter temporal = filter_for(format);
        temporal.predictor = Predictor::kReference;
        EXPECT_LT(filter_cost(temporal, size_of(plane), plane.bytes, near.bytes) * 4,
                  filter_cost(filter_for(format), size_of(plane), plane.bytes, {}))
            << name_of(format);
        const Plane ramp = ramp_plane(format, 64, 40);
        ByteFilter left = temporal;
        left.predictor = Predictor::kLeft;
        EXPECT_GT(filter_cost(temporal, size_of(ramp), ramp.bytes, plane.bytes),
                  filter_cost(left, size_of(ramp), ramp.bytes, {}))
            << name_of(format);
    }
}

} // namespace
} // namespace fieldcast::codec
