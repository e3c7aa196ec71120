// SPDX-License-Identifier: Apache-2.0
#include "core/codec/light_curve.h"

#include "core/codec/channel_layout.h"
#include "tests/wire/test_planes.h"

#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>

namespace fieldcast::codec {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::uint32_t kInfinity = 31U << 6; ///< bits of a float of 11 bits

Bytes pixels_of(const std::vector<std::uint32_t>& words) {
    Bytes pixels(4 * words.size());
    for (std::size_t i = 0; i < words.size(); ++i) {
        store_word(&pixels[4 * i], words[i]);
    }
    return pixels;
}

std::uint32_t grey(std::uint32_t bits11) {
    return bits11 | bits11 << 11 | bits11 / 2 << 22;
}

/// Value of `bits` of an unsigned float with five bits of exponent.
double value_of(std::uint32_t bits, int mantissa_bits) {
    const auto exponent = static_cast<int>(bits >> mantissa_bits);
    const double mantissa = (bits & ((1U << mantissa_bits) - 1U)) / std::exp2(mantissa_bits);
    return exponent == 0 ? std::exp2(-14) * mantissa : std::exp2(exponent - 15) * (1.0 + mantissa);
}

Bytes round_trip(const LightCurve& curve, const Bytes& pixels) {
    Bytes samples(pixels.size() / 4 * 3);
    samples_from_light(curve, pixels, samples);
    Bytes back(pixels.size());
    light_from_samples(curve, samples, back);
    return back;
}

TEST(LightCurve, EveryValueComesBackWithinHalfAStep) {
    std::vector<std::uint32_t> words;
    for (std::uint32_t bits = 0; bits < kInfinity; ++bits) {
        words.push_back(grey(bits));
    }
    const Bytes pixels = pixels_of(words);
    const LightCurve curve = light_curve_for(pixels, 4.0F);
    EXPECT_FLOAT_EQ(curve.top, 65024.0F); // the largest float of 11 bits
    const Bytes back = round_trip(curve, pixels);
    const double half_step = std::expm1(0.5 * std::log1p(curve.top / curve.knee) / 255.0);
    for (std::size_t i = 0; i < words.size(); ++i) {
        const auto now = load_word<std::uint32_t>(&back[4 * i]);
        for (const auto& [shift, mantissa_bits] : {std::pair(0, 6), std::pair(11, 6), std::pair(22, 5)}) {
            const std::uint32_t mask = (1U << (mantissa_bits + 5)) - 1U;
            const double before = value_of(words[i] >> shift & mask, mantissa_bits);
            const double after = value_of(now >> shift & mask, mantissa_bits);
            // Half a step of the curve, and half a step of the float that the result is rounded to.
            const double half_ulp = after / std::exp2(mantissa_bits) + std::exp2(-20);
            const double allowed = half_step * (before + curve.knee) + half_ulp;
            ASSERT_NEAR(after, before, allowed * 1.001) << i << " shift " << shift;
        }
    }
}

TEST(LightCurve, DarknessStaysDark) {
    const Bytes black = pixels_of({0, 0, 0});
    EXPECT_EQ(round_trip(light_curve_for(black, 1.0F), black), black);
    EXPECT_EQ(round_trip({.knee = 0.01F, .top = 100.0F}, black), black);
}

TEST(LightCurve, BrokenValuesDoNotSpoilTheRest) {
    const std::uint32_t one = grey(15U << 6);
    const Bytes pixels = pixels_of({one, grey(kInfinity), grey(kInfinity + 2)});
    const LightCurve curve = light_curve_for(pixels, 1.0F);
    EXPECT_EQ(curve.top, 1.0F);
    EXPECT_EQ(round_trip(curve, pixels), pixels_of({one, one, 0})); // infinity: the top; NaN: nothing
}

TEST(LightCurve, KneeFollowsTheExposure) {
    const Bytes pixels = pixels_of({grey(15U << 6)});
    EXPECT_FLOAT_EQ(light_curve_for(pixels, 0.5F).knee, 8.0F * light_curve_for(pixels, 4.0F).knee);
    for (const float exposure : {1e-30F, 1e30F}) { // whatever a channel was told: a curve that decodes
        EXPECT_TRUE(decode_curve(encode_curve(light_curve_for(pixels, exposure)))) << exposure;
    }
}

TEST(LightCurve, TravelsAsBytes) {
    const LightCurve curve{.knee = 0.0125F, .top = 17.5F};
    const auto decoded = decode_curve(encode_curve(curve));
    ASSERT_TRUE(decoded);
    EXPECT_EQ(*decoded, curve);
}

TEST(LightCurve, RefusesCurvesThatAreNone) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInf = std::numeric_limits<float>::infinity();
    for (const float bad : {0.0F, -1.0F, kNan, kInf, 1e30F, 1e-30F}) {
        EXPECT_FALSE(decode_curve(encode_curve({.knee = bad, .top = 1.0F}))) << bad;
        EXPECT_FALSE(decode_curve(encode_curve({.knee = 1.0F, .top = bad}))) << bad;
    }
    const auto bytes = encode_curve({});
    EXPECT_FALSE(decode_curve(std::span(bytes).first(7)));
}

// The extremes that decode: tables stay finite, nothing is written outside (sanitizer builds see that).
TEST(LightCurve, ExtremesDecode) {
    Bytes samples(3 * 256);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        samples[i] = static_cast<std::byte>(i / 3);
    }
    for (const LightCurve& curve : {LightCurve{0x1p-40F, 0x1p40F}, LightCurve{0x1p40F, 0x1p-40F}}) {
        Bytes pixels(4 * 256);
        light_from_samples(curve, samples, pixels);
        std::uint32_t before = 0;
        for (std::size_t i = 0; i < 256; ++i) {
            const std::uint32_t red = load_word<std::uint32_t>(&pixels[4 * i]) & 0x7FF;
            EXPECT_LT(red, kInfinity);
            EXPECT_GE(red, before);
            before = red;
        }
    }
}

} // namespace
} // namespace fieldcast::codec
