// SPDX-License-Identifier: Apache-2.0
#include "core/codec/h264.h"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <random>
#include <string>

namespace fieldcast::codec {
namespace {

using ::testing::HasSubstr;

using Bytes = std::vector<std::byte>;

/// A soft picture, seen from `offset_px` further to the right.
Bytes soft_rgb(RgbSize size, double offset_px = 0.0) {
    Bytes rgb;
    for (std::size_t i = 0; i < size.bytes(); ++i) {
        const double x = static_cast<double>(i / 3 % size.width_px) + offset_px;
        const auto y = static_cast<double>(i / 3 / size.width_px);
        const auto channel = static_cast<double>(i % 3);
        rgb.push_back(static_cast<std::byte>(128.0 + 60.0 * std::sin(0.11 * x + 0.07 * y + 0.4 * channel) +
                                             30.0 * std::sin(0.9 * x) * std::sin(0.8 * y)));
    }
    return rgb;
}

double psnr_db(const Bytes& a, const Bytes& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double difference = std::to_integer<int>(a[i]) - std::to_integer<int>(b[i]);
        sum += difference * difference;
    }
    return 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(a.size()) / sum);
}

Bytes decoded(const Bytes& base, const Bytes& picture, RgbSize size) {
    Bytes rgb(size.bytes());
    const auto result = decode_h264(base, picture, size, rgb);
    EXPECT_TRUE(result) << result.error().message;
    return rgb;
}

std::string refusal(const Bytes& base, const Bytes& picture, RgbSize size) {
    Bytes rgb(size.bytes());
    const auto result = decode_h264(base, picture, size, rgb);
    return result ? "nothing" : result.error().message;
}

TEST(H264, RoundTripsEverySize) {
    for (const RgbSize size : {RgbSize{1, 1}, RgbSize{7, 3}, RgbSize{33, 20}, RgbSize{640, 120}, RgbSize{64, 361}}) {
        const Bytes rgb = soft_rgb(size);
        // Quality 95 quantises in steps of 5 (qp 18): uniform errors of ±2.5 are 45 dB. Colours at half the resolution
        // cost more the smaller the picture is: 39.7 dB are left of 7x3.
        EXPECT_GT(psnr_db(decoded({}, encode_h264(rgb, size, 95), size), rgb), 38.0)
            << size.width_px << "x" << size.row_count;
    }
}

TEST(H264, QualityTradesBytesForErrors) {
    const RgbSize size{320, 120};
    const Bytes rgb = soft_rgb(size);
    const Bytes small = encode_h264(rgb, size, 30);
    const Bytes good = encode_h264(rgb, size, 90);
    EXPECT_LT(small.size(), good.size());
    // The steps of both differ by a factor of 9.
    EXPECT_LT(psnr_db(decoded({}, small, size), rgb) + 6.0, psnr_db(decoded({}, good, size), rgb));
}

TEST(H264, PredictedPicturesAreSmallerAndAsGood) {
    const RgbSize size{320, 120};
    const Bytes base_rgb = soft_rgb(size);
    const Bytes rgb = soft_rgb(size, 5.0);
    const Bytes base = encode_h264(base_rgb, size, 75);
    const Bytes alone = encode_h264(rgb, size, 75);
    const Bytes predicted = encode_h264_from(base_rgb, rgb, size, 75);
    EXPECT_LT(2 * predicted.size(), alone.size());
    // Same quantiser; what is skipped keeps the error of the base, so a little may be lost.
    EXPECT_GT(psnr_db(decoded(base, predicted, size), rgb), psnr_db(decoded({}, alone, size), rgb) - 2.0);
}

TEST(H264, SamePictureGivesSameBytes) {
    const RgbSize size{64, 48};
    const Bytes rgb = soft_rgb(size);
    EXPECT_EQ(encode_h264(rgb, size, 75), encode_h264(rgb, size, 75));
    EXPECT_EQ(encode_h264_from(rgb, soft_rgb(size, 2.0), size, 75),
              encode_h264_from(rgb, soft_rgb(size, 2.0), size, 75));
}

TEST(H264, RefusesWhatIsNotOnePicture) {
    const RgbSize size{64, 48};
    const Bytes rgb = soft_rgb(size);
    const Bytes base = encode_h264(rgb, size, 75);
    const Bytes predicted = encode_h264_from(rgb, soft_rgb(size, 3.0), size, 75);
    Bytes twice = base;
    twice.insert(twice.end(), predicted.begin(), predicted.end());
    EXPECT_THAT(refusal({}, {}, size), HasSubstr("no byte stream"));
    EXPECT_THAT(refusal({}, Bytes(100), size), HasSubstr("no byte stream"));
    EXPECT_THAT(refusal({}, predicted, size), HasSubstr("expected a sequence"));
    EXPECT_THAT(refusal({}, twice, size), HasSubstr("slices of one picture"));
    EXPECT_THAT(refusal(base, base, size), HasSubstr("slices of one picture"));
    EXPECT_THAT(refusal(predicted, predicted, size), HasSubstr("expected a sequence"));
    EXPECT_THAT(refusal({}, base, {64, 64}), HasSubstr("not of frames of 64x64"));
    EXPECT_THAT(refusal({}, base, {66, 48}), HasSubstr("not of frames of 66x48"));
    EXPECT_THAT(refusal({}, base, {5000, 48}), HasSubstr("at most 4096"));
}

TEST(H264, EveryTruncationIsRefused) {
    const RgbSize size{64, 48};
    const Bytes rgb = soft_rgb(size);
    const Bytes base = encode_h264(rgb, size, 75);
    const Bytes predicted = encode_h264_from(rgb, soft_rgb(size, 3.0), size, 75);
    for (std::size_t cut = 0; cut + 1 < base.size(); ++cut) { // the last byte may be padding
        EXPECT_NE(refusal({}, Bytes(base.begin(), base.begin() + static_cast<std::ptrdiff_t>(cut)), size), "nothing")
            << cut;
    }
    EXPECT_NE(refusal(base, Bytes(predicted.begin(), predicted.begin() + 8), size), "nothing");
}

// What is damaged may decode to other pixels: only the checksum of the frame can tell.
TEST(H264, RandomDamageNeverCrashes) {
    const RgbSize size{64, 48};
    const Bytes rgb = soft_rgb(size);
    const Bytes base = encode_h264(rgb, size, 75);
    const Bytes predicted = encode_h264_from(rgb, soft_rgb(size, 3.0), size, 75);
    std::mt19937 random(5);
    int refused = 0;
    for (int round = 0; round < 400; ++round) {
        Bytes damaged = round % 2 == 0 ? base : predicted;
        for (auto flips = 1 + random() % 3; flips > 0; --flips) {
            damaged[random() % damaged.size()] ^= static_cast<std::byte>(1U << random() % 8);
        }
        refused += refusal(round % 2 == 0 ? Bytes{} : base, damaged, size) == "nothing" ? 0 : 1;
    }
    EXPECT_GT(refused, 100); // arithmetic coding notices most damage: it runs out of range, or past the end
}

} // namespace
} // namespace fieldcast::codec
