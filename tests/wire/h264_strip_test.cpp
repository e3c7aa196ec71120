// SPDX-License-Identifier: Apache-2.0
#include "core/codec/plane_codec.h"

#include "tests/wire/test_files.h"
#include "tests/wire/test_planes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fieldcast::codec {
namespace {

using namespace fieldcast::testing;
using ::testing::HasSubstr;

constexpr RowBand kBand{3, 15};
constexpr Encoding kH264{Codec::kH264, 75};

/// A soft picture: kRgb8, 33 × 20 pixels, moved to the left.
Plane soft_plane(std::uint32_t offset_px = 0) {
    Plane plane = empty_plane(PlaneFormat::kRgb8, 33, 20);
    for (std::size_t i = 0; i < plane.bytes.size(); ++i) {
        const auto pixel = static_cast<std::uint32_t>(i / 3);
        plane.bytes[i] = static_cast<std::byte>(4 * (pixel % 33 + offset_px) + 3 * (pixel / 33));
    }
    return plane;
}

std::string refusal(std::span<const std::byte> strip, const Announced& announced) {
    Plane plane = empty_plane(PlaneFormat::kRgb8, 33, 20);
    const auto result = decode_strip(strip, kBand, announced, plane);
    return result ? "nothing" : result.error().message;
}

/// Largest difference within the band; what lies outside must be zero.
int largest_error(const Plane& decoded, const Plane& sent) {
    int largest = 0;
    for (std::size_t i = 0; i < decoded.bytes.size(); ++i) {
        const int ours = std::to_integer<int>(decoded.bytes[i]);
        if (i / 99 < 3 || i / 99 >= 18) {
            EXPECT_EQ(ours, 0) << i;
        } else {
            largest = std::max(largest, std::abs(ours - std::to_integer<int>(sent.bytes[i])));
        }
    }
    return largest;
}

TEST(H264Strip, StandsAloneOrIsPredicted) {
    const Plane base_plane = soft_plane();
    const Plane plane = soft_plane(2);
    const auto base = encode_strip(base_plane, kBand, {.encoding = kH264});
    const auto strip = encode_strip(plane, kBand, {.encoding = kH264, .base = &base_plane});
    EXPECT_EQ(base[1], static_cast<std::byte>(StripCoding::kH264));
    EXPECT_TRUE(can_be_base(base));
    EXPECT_FALSE(can_be_base(strip));
    EXPECT_FALSE(needs_reference(strip)) << "what is meant is another frame";
    Plane decoded = empty_plane(PlaneFormat::kRgb8, 33, 20);
    ASSERT_TRUE(decode_strip(base, kBand, {.codec = Codec::kH264}, decoded));
    EXPECT_LE(largest_error(decoded, base_plane), 24); // a quantiser of 24 has steps of 10
    decoded = empty_plane(PlaneFormat::kRgb8, 33, 20);
    ASSERT_TRUE(decode_strip(strip, kBand, {.codec = Codec::kH264, .base = base}, decoded));
    EXPECT_LE(largest_error(decoded, plane), 24);
}

TEST(H264Strip, IsRefusedWithoutItsBase) {
    const Plane base_plane = soft_plane();
    const auto base = encode_strip(base_plane, kBand, {.encoding = kH264});
    const auto strip = encode_strip(soft_plane(2), kBand, {.encoding = kH264, .base = &base_plane});
    const auto raw = encode_strip(base_plane, kBand, {.encoding = {Codec::kRaw}});
    const auto other_rows = encode_strip(base_plane, {0, 15}, {.encoding = kH264});
    const Codec h264 = Codec::kH264;
    EXPECT_THAT(refusal(strip, {.codec = h264}), HasSubstr("has no such strip"));
    EXPECT_THAT(refusal(strip, {.codec = h264, .base = raw}), HasSubstr("has no such strip"));
    EXPECT_THAT(refusal(strip, {.codec = h264, .base = strip}), HasSubstr("has no such strip"));
    EXPECT_THAT(refusal(strip, {.codec = h264, .base = other_rows}), HasSubstr("has no such strip"));
    EXPECT_THAT(refusal(strip, {.codec = Codec::kJpeg, .base = base}), HasSubstr("plane of another codec"));
    EXPECT_THAT(refusal(base, {.codec = Codec::kZstdFiltered}), HasSubstr("plane of another codec"));
    EXPECT_EQ(refusal(base, {.codec = h264, .base = raw}), "nothing") << "what stands alone needs no base";
}

TEST(H264Strip, DamagedHeadersAreRefused) {
    auto strip = encode_strip(soft_plane(), kBand, {.encoding = kH264});
    strip[5] = std::byte{2};
    EXPECT_THAT(refusal(strip, {.codec = Codec::kH264}), HasSubstr("flags"));
    strip[5] = std::byte{0};
    strip[3] = std::byte{1};
    EXPECT_THAT(refusal(strip, {.codec = Codec::kH264}), HasSubstr("only ZSTD_FILTERED has a filter"));
}

TEST(H264Strip, IsForPicturesOnly) {
    for (const PlaneFormat format : kAllFormats) {
        EXPECT_EQ(carries(Codec::kH264, format), format == PlaneFormat::kRgb8) << name_of(format);
    }
    EXPECT_TRUE(is_lossy(Codec::kH264));
}

TEST(H264Strip, FallsBackToRawWhereItIsLarger) {
    const Plane plane = random_plane(PlaneFormat::kRgb8, 4, 4); // 48 bytes; parameter sets alone have 30
    const auto strip = encode_strip(plane, {0, 4}, {.encoding = kH264});
    EXPECT_EQ(strip[1], static_cast<std::byte>(StripCoding::kRaw));
    EXPECT_FALSE(can_be_base(strip));
}

TEST(H264Strip, RepeatsWhatTheReceiverHas) {
    const Plane plane = soft_plane();
    const auto strip = encode_strip(plane, kBand, {.encoding = kH264, .reference = &plane});
    EXPECT_EQ(strip[1], static_cast<std::byte>(StripCoding::kRepeat));
    EXPECT_FALSE(can_be_base(strip));
}

// Strips of every released version decode for ever, to the same pixels: H.264 leaves a decoder no choice.
TEST(H264Strip, Version1Decodes) {
    const auto base = read_bytes("tests/data/wire/v1/rgb8_h264.strip");
    Plane decoded = empty_plane(PlaneFormat::kRgb8, 33, 20);
    const auto first = decode_strip(base, kBand, {.codec = Codec::kH264}, decoded);
    ASSERT_TRUE(first) << first.error().message;
    EXPECT_LE(largest_error(decoded, soft_plane()), 24);
    decoded = empty_plane(PlaneFormat::kRgb8, 33, 20);
    const auto second = decode_strip(read_bytes("tests/data/wire/v1/rgb8_h264_predicted.strip"), kBand,
                                     {.codec = Codec::kH264, .base = base}, decoded);
    ASSERT_TRUE(second) << second.error().message;
    EXPECT_LE(largest_error(decoded, soft_plane(2)), 24);
}

} // namespace
} // namespace fieldcast::codec
