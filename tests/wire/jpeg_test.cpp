// SPDX-License-Identifier: Apache-2.0
#include "core/codec/jpeg.h"

#include "tests/wire/other_jpeg.h"
#include "tests/wire/test_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fieldcast::codec {
namespace {

using namespace fieldcast::testing;
using ::testing::HasSubstr;

using Bytes = std::vector<std::byte>;

/// A soft picture: what a codec for pictures is made for.
Bytes soft_rgb(RgbSize size) {
    Bytes rgb;
    for (std::size_t i = 0; i < size.bytes(); ++i) {
        const auto x = static_cast<double>(i / 3 % size.width_px);
        const auto y = static_cast<double>(i / 3 / size.width_px);
        const auto channel = static_cast<double>(i % 3);
        rgb.push_back(static_cast<std::byte>(128.0 + 100.0 * std::sin(0.11 * x + 0.07 * y + channel)));
    }
    return rgb;
}

double rms_error(const Bytes& a, const Bytes& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double difference = std::to_integer<int>(a[i]) - std::to_integer<int>(b[i]);
        sum += difference * difference;
    }
    return std::sqrt(sum / static_cast<double>(a.size()));
}

Bytes decoded(const Bytes& file, RgbSize size) {
    Bytes rgb(size.bytes());
    const auto result = decode_jpeg(file, size, rgb);
    EXPECT_TRUE(result) << result.error().message;
    return rgb;
}

void expect_refused(const Bytes& file, RgbSize size, const std::string& message) {
    Bytes rgb(size.bytes());
    const auto result = decode_jpeg(file, size, rgb);
    ASSERT_FALSE(result) << message;
    EXPECT_THAT(result.error().message, HasSubstr(message));
}

TEST(Jpeg, RoundTripsEverySize) {
    for (const RgbSize size : {RgbSize{1, 1}, RgbSize{7, 3}, RgbSize{33, 20}, RgbSize{640, 120}, RgbSize{16384, 2}}) {
        const Bytes rgb = soft_rgb(size);
        // Steps of quality 95 are 2.7 and more for Y, four times that for colours: an error of a third of a step each.
        EXPECT_LT(rms_error(decoded(encode_jpeg(rgb, size, {.quality = 95}), size), rgb), 3.7)
            << size.width_px << "x" << size.row_count;
    }
}

TEST(Jpeg, BetterQualityIsLargerAndCloser) {
    const RgbSize size{320, 120};
    Bytes rgb = soft_rgb(size);
    const Plane noise = random_plane(PlaneFormat::kRgb8, size.width_px, size.row_count);
    for (std::size_t i = 0; i < rgb.size(); ++i) {
        rgb[i] = static_cast<std::byte>(std::to_integer<int>(rgb[i]) + std::to_integer<int>(noise.bytes[i]) % 20);
    }
    std::size_t bytes = 0;
    double error = 1e9;
    for (const int quality : {1, 20, 50, 75, 90, 100}) {
        const Bytes file = encode_jpeg(rgb, size, {.quality = static_cast<std::uint8_t>(quality)});
        const double now = rms_error(decoded(file, size), rgb);
        EXPECT_GT(file.size(), bytes) << quality;
        EXPECT_LT(now, error) << quality;
        bytes = file.size();
        error = now;
    }
    EXPECT_LT(error, 2.5); // steps of 1 for Y and 4 to 6 for colours
}

TEST(Jpeg, TakesWhatOthersWrite) {
    const RgbSize size{33, 20};
    const Bytes rgb = soft_rgb(size);
    EXPECT_LT(rms_error(decoded(other_jpeg(rgb, 33, 20, JpegKind::kBaseline), size), rgb), 6.0);
}

TEST(Jpeg, OtherKindsAreRefused) {
    const RgbSize size{33, 20};
    const Bytes rgb = soft_rgb(size);
    expect_refused(other_jpeg(rgb, 33, 20, JpegKind::kSubsampled), size, "subsampled");
    expect_refused(other_jpeg(rgb, 33, 20, JpegKind::kProgressive), size, "not baseline");
    expect_refused(other_jpeg(rgb, 33, 20, JpegKind::kScanPerComponent), size, "not baseline");
    expect_refused(other_jpeg(rgb, 33, 20, JpegKind::kArithmetic), size, "not baseline");
    expect_refused(other_jpeg(rgb, 33, 20, JpegKind::kGrey), size, "three components");
    expect_refused(other_jpeg(rgb, 33, 20, JpegKind::kRgb), size, "three components");
}

TEST(Jpeg, OtherSizesAreRefusedBeforeAnythingIsDecoded) {
    const RgbSize size{33, 20};
    Bytes file = encode_jpeg(soft_rgb(size), size, {});
    expect_refused(file, {32, 20}, "another size");
    expect_refused(file, {33, 21}, "another size");
    // Height and width of the frame header, which follows the marker FF C0, its length and the precision.
    constexpr std::array kMarker{std::byte{0xFF}, std::byte{0xC0}};
    const auto marker = std::search(file.begin(), file.end(), kMarker.begin(), kMarker.end());
    ASSERT_NE(marker, file.end());
    std::fill_n(marker + 5, 4, std::byte{0x40}); // 16448x16448
    expect_refused(file, size, "another size");
}

TEST(Jpeg, EveryTruncationIsRefused) {
    const RgbSize size{33, 20};
    const Bytes file = encode_jpeg(soft_rgb(size), size, {});
    for (std::size_t length = 0; length < file.size(); ++length) {
        Bytes rgb(size.bytes());
        EXPECT_FALSE(decode_jpeg(std::span(file).first(length), size, rgb)) << length;
    }
}

TEST(Jpeg, BytesAfterTheEndAreRefused) {
    const RgbSize size{33, 20};
    Bytes file = encode_jpeg(soft_rgb(size), size, {});
    file.push_back(std::byte{0});
    expect_refused(file, size, "after the end");
}

// Whatever stands in a file, decoding ends and writes nowhere but into the rows (sanitizer builds see both).
TEST(Jpeg, RandomDamageIsSurvived) {
    std::mt19937 random(3);
    const RgbSize size{33, 20};
    const Bytes file = encode_jpeg(soft_rgb(size), size, {});
    Bytes rgb(size.bytes() + 64, std::byte{0x5A});
    for (int round = 0; round < 5000; ++round) {
        Bytes damaged = file;
        for (auto flips = 1 + random() % 4; flips > 0; --flips) {
            damaged[random() % damaged.size()] = static_cast<std::byte>(random());
        }
        static_cast<void>(decode_jpeg(damaged, size, std::span(rgb).first(size.bytes())));
    }
    for (std::size_t i = size.bytes(); i < rgb.size(); ++i) {
        ASSERT_EQ(rgb[i], std::byte{0x5A});
    }
}

} // namespace
} // namespace fieldcast::codec
