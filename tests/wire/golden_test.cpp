// SPDX-License-Identifier: Apache-2.0
// Strips of every released version decode for ever. Files: make_golden_strips.cpp.
#include "core/codec/byte_filter.h"
#include "core/codec/plane_codec.h"

#include "tests/wire/test_files.h"
#include "tests/wire/test_planes.h"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <iterator>

namespace fieldcast::codec {
namespace {

using namespace fieldcast::testing;

void expect_golden(PlaneFormat format, const std::string& codec) {
    const RowBand band{3, 15};
    const Plane expected = ramp_plane(format, 33, 20);
    Plane decoded = expected;
    const std::size_t row_bytes = 33 * bytes_per_pixel(format);
    std::fill_n(decoded.bytes.begin() + static_cast<std::ptrdiff_t>(3 * row_bytes), 15 * row_bytes, std::byte{0});
    const auto strip = read_bytes("tests/data/wire/v1/" + name_of(format) + "_" + codec + ".strip");
    const Plane reference = codec == "repeat" ? expected : ramp_plane(format, 33, 20, 1);
    const auto result = decode_strip(strip, band, {.reference = &reference}, decoded);
    ASSERT_TRUE(result) << name_of(format) << ": " << result.error().message;
    EXPECT_TRUE(decoded == expected) << name_of(format);
}

TEST(GoldenStrips, Version1RawDecodes) {
    for (const PlaneFormat format : kAllFormats) {
        expect_golden(format, "raw");
    }
}

TEST(GoldenStrips, Version1ZstdDecodes) {
    for (const PlaneFormat format : kAllFormats) {
        expect_golden(format, "zstd");
    }
}

TEST(GoldenStrips, Version1FiltersDecode) {
    for (const PlaneFormat format : kAllFormats) {
        expect_golden(format, "predicted");
        expect_golden(format, "reference");
        expect_golden(format, "repeat");
    }
}

TEST(GoldenStrips, Version1JpegDecodes) {
    const Plane expected = ramp_plane(PlaneFormat::kRgb8, 33, 20);
    Plane decoded = expected;
    std::fill_n(decoded.bytes.begin() + 3 * 99, 15 * 99, std::byte{0});
    const auto result =
        decode_strip(read_bytes("tests/data/wire/v1/rgb8_jpeg.strip"), {3, 15}, {.codec = Codec::kJpeg}, decoded);
    ASSERT_TRUE(result) << result.error().message;
    int largest = 0;
    for (std::size_t i = 0; i < decoded.bytes.size(); ++i) {
        const int difference = std::to_integer<int>(decoded.bytes[i]) - std::to_integer<int>(expected.bytes[i]);
        largest = std::max(largest, std::abs(difference));
    }
    EXPECT_LE(largest, 16); // measured 12: steps of 2.2 and more in 64 coefficients of Y, 6.6 and more in Cb and Cr
    EXPECT_GT(largest, 0);  // it is not lossless
}

TEST(GoldenStrips, Version1JpegOfLightDecodes) {
    const Plane expected = light_plane(33, 20);
    Plane decoded = expected;
    std::fill_n(decoded.bytes.begin() + 3 * 132, 15 * 132, std::byte{0});
    const auto strip = read_bytes("tests/data/wire/v1/r11g11b10f_jpeg.strip");
    const auto result = decode_strip(strip, {3, 15}, {.codec = Codec::kJpeg}, decoded);
    ASSERT_TRUE(result) << result.error().message;
    int largest = 0;
    for (std::size_t i = 0; i < 33 * 20; ++i) {
        const int green = green_bits(expected, i);
        largest = green != 0 ? std::max(largest, std::abs(green_bits(decoded, i) - green)) : largest;
    }
    EXPECT_LE(largest, 24); // of 64 to an octave
    EXPECT_GT(largest, 0);
}

TEST(GoldenStrips, EncoderStillWritesTheSameHeaders) {
    for (const PlaneFormat format : kAllFormats) {
        const auto golden = read_bytes("tests/data/wire/v1/" + name_of(format) + "_predicted.strip");
        const auto strip = encode_strip(ramp_plane(format, 33, 20), {3, 15}, {});
        ASSERT_GE(golden.size(), kStripHeaderBytes);
        // The body may differ with another zstd version, and so may its size (bytes 12 … 15).
        EXPECT_TRUE(std::equal(strip.begin(), strip.begin() + 12, golden.begin())) << name_of(format);
    }
}

// The worked example of docs/protocol.md, byte for byte.
class WorkedExample : public ::testing::Test {
protected:
    template <std::size_t kSize> static std::vector<std::byte> bytes_of(const std::array<std::uint8_t, kSize>& values) {
        std::vector<std::byte> bytes;
        std::ranges::transform(values, std::back_inserter(bytes), [](auto value) { return std::byte{value}; });
        return bytes;
    }

    const Plane plane_{PlaneSemantic::kMaterial, PlaneFormat::kRg8, 2, 2,
                       bytes_of(std::to_array<std::uint8_t>({10, 200, 12, 201, 11, 200, 14, 203}))};
};

TEST_F(WorkedExample, RawStrip) {
    const auto expected = bytes_of(std::to_array<std::uint8_t>(
        {1, 1, 5, 0, 0, 0, 2, 0, 0, 0, 2, 0, 8, 0, 0, 0, 10, 200, 12, 201, 11, 200, 14, 203}));
    EXPECT_EQ(encode_strip(plane_, {0, 2}, {.encoding = {Codec::kRaw}}), expected);
}

TEST_F(WorkedExample, FilteredBytes) {
    std::vector<std::byte> filtered(8);
    filter_band({Predictor::kGradient, Layout::kBytes}, {2, 2, 2}, plane_.bytes, {}, filtered);
    EXPECT_EQ(filtered, bytes_of(std::to_array<std::uint8_t>({10, 2, 1, 1, 200, 1, 0, 2})));
    std::vector<std::byte> pixels(8);
    unfilter_band({Predictor::kGradient, Layout::kBytes}, {2, 2, 2}, filtered, {}, pixels);
    EXPECT_EQ(pixels, plane_.bytes);
}

TEST_F(WorkedExample, ZstdStripWithStoredBlock) {
    const auto strip = bytes_of(std::to_array<std::uint8_t>(
        {1,    2,    5,    2,    1,    0, 2,    0, 0, 0,  2, 0, 17, 0,   0, 0,       // strip header
         0x28, 0xB5, 0x2F, 0xFD, 0x20, 8, 0x41, 0, 0, 10, 2, 1, 1,  200, 1, 0, 2})); // zstd frame
    Plane decoded = empty_plane(PlaneFormat::kRg8, 2, 2);
    const auto result = decode_strip(strip, {0, 2}, {}, decoded);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(decoded.bytes, plane_.bytes);
}

} // namespace
} // namespace fieldcast::codec
