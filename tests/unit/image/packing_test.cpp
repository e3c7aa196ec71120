// SPDX-License-Identifier: Apache-2.0
#include "core/image/packing.h"

#include "core/lightfield/normal_precision.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace fieldcast::image {
namespace {

/// A small unsigned float is a half without sign and without its last mantissa bits.
float reference_decode(std::uint32_t bits, int missing_mantissa_bits) {
    return glm::unpackHalf1x16(static_cast<std::uint16_t>(bits << missing_mantissa_bits));
}

TEST(PackR11G11B10F, DecodesEveryCodeLikeAHalf) {
    for (std::uint32_t code = 0; code < 2048; ++code) {
        const float expected = reference_decode(code, 4);
        const glm::vec3 red = unpack_r11g11b10f(code);
        const glm::vec3 green = unpack_r11g11b10f(code << 11);
        ASSERT_TRUE(red.r == expected || (std::isnan(red.r) && std::isnan(expected))) << code;
        ASSERT_TRUE(green.g == expected || (std::isnan(green.g) && std::isnan(expected))) << code;
        ASSERT_EQ(red.g, 0.0F);
        ASSERT_EQ(red.b, 0.0F);
    }
    for (std::uint32_t code = 0; code < 1024; ++code) {
        const float expected = reference_decode(code, 5);
        const glm::vec3 blue = unpack_r11g11b10f(code << 22);
        ASSERT_TRUE(blue.b == expected || (std::isnan(blue.b) && std::isnan(expected))) << code;
    }
}

TEST(PackR11G11B10F, RoundTripsEveryFiniteCode) {
    for (std::uint32_t code = 0; code < 31U << 6; ++code) {
        const std::uint32_t word = code | ((31U << 6) - 1 - code) << 11 | (code >> 1) << 22;
        ASSERT_EQ(pack_r11g11b10f(unpack_r11g11b10f(word)), word) << code;
    }
}

TEST(PackR11G11B10F, RoundsToNearestAndTiesToEven) {
    for (std::uint32_t code = 0; code + 1 < 31U << 6; ++code) {
        const float low = unpack_r11g11b10f(code).r;
        const float high = unpack_r11g11b10f(code + 1).r;
        const float middle = 0.5F * (low + high); // exact: halves have more mantissa bits
        const std::uint32_t even = code % 2 == 0 ? code : code + 1;
        ASSERT_EQ(pack_r11g11b10f({middle, 0.0F, 0.0F}), even) << code;
        ASSERT_EQ(pack_r11g11b10f({std::nextafter(middle, 0.0F), 0.0F, 0.0F}), code) << code;
        ASSERT_EQ(pack_r11g11b10f({std::nextafter(middle, high), 0.0F, 0.0F}), code + 1) << code;
    }
}

TEST(PackR11G11B10F, KeepsEveryInputFinite) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(unpack_r11g11b10f(pack_r11g11b10f(glm::vec3(kInfinity))), glm::vec3(65024.0F, 65024.0F, 64512.0F));
    EXPECT_EQ(unpack_r11g11b10f(pack_r11g11b10f(glm::vec3(3e38F))), glm::vec3(65024.0F, 65024.0F, 64512.0F));
    EXPECT_EQ(unpack_r11g11b10f(pack_r11g11b10f(glm::vec3(65500.0F))), glm::vec3(65024.0F, 65024.0F, 64512.0F));
    EXPECT_EQ(pack_r11g11b10f({-1.0F, std::numeric_limits<float>::quiet_NaN(), -kInfinity}), 0U);
    EXPECT_EQ(pack_r11g11b10f(glm::vec3(std::numeric_limits<float>::denorm_min())), 0U);
}

/// 0.004° is what the header promises; quantisation alone gives half a step of 1/32767 per axis, stretched by the
/// octahedron by at most √3: 0.5 · √2 · √3 / 32767 rad = 0.0021°.
TEST(PackOct2x16, AngularErrorStaysBelowTheStatedBound) {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    double worst_rad = 0.0;
    for (int i = 0; i < 200000; ++i) {
        const glm::vec3 direction = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
        const glm::vec3 read = unpack_oct2x16(pack_oct2x16(direction));
        ASSERT_NEAR(glm::length(read), 1.0F, 1e-6F);
        worst_rad = std::max(worst_rad, static_cast<double>(glm::length(read - direction)));
    }
    EXPECT_LT(worst_rad * 180.0 / 3.14159265, 0.004);
}

TEST(PackOct2x16, KeepsAxesAndSigns) {
    for (const glm::vec3 axis : {glm::vec3(1, 0, 0), glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, -1, 0),
                                 glm::vec3(0, 0, 1), glm::vec3(0, 0, -1)}) {
        EXPECT_EQ(unpack_oct2x16(pack_oct2x16(axis)), axis);
    }
    EXPECT_EQ(pack_oct2x16({0, 0, 1}), 0U);
    EXPECT_EQ(pack_oct2x16({1, 0, 0}), 0x7FFFU) << "x is in the low bits";
}

TEST(PackOct2x16, EveryWordIsAUnitVector) {
    std::mt19937 random(2);
    for (int i = 0; i < 100000; ++i) {
        ASSERT_NEAR(glm::length(unpack_oct2x16(static_cast<std::uint32_t>(random()))), 1.0F, 1e-6F);
    }
    EXPECT_NEAR(glm::length(unpack_oct2x16(0x80008000U)), 1.0F, 1e-6F) << "−32768 counts as −1";
}

/// 1° is what the header promises. Half a step of 1/127 in both components is √6 / 254 in the plane of a face, whose
/// middle is 1/√3 from the centre: √18 / 254 rad = 0.957°.
TEST(PackOct2x8, AngularErrorStaysBelowTheStatedBound) {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    double worst_rad = 0.0;
    for (int i = 0; i < 200000; ++i) {
        const glm::vec3 direction = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
        const glm::vec3 read = unpack_oct2x8(pack_oct2x8(direction));
        ASSERT_NEAR(glm::length(read), 1.0F, 1e-6F);
        worst_rad = std::max(worst_rad, static_cast<double>(glm::length(read - direction)));
    }
    EXPECT_LT(worst_rad * 180.0 / 3.14159265, 1.0);
    EXPECT_GT(worst_rad * 180.0 / 3.14159265, 0.5) << "8 bits cannot do better";
}

TEST(PackOct2x8, KeepsAxes) {
    for (const glm::vec3 axis : {glm::vec3(1, 0, 0), glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, -1, 0),
                                 glm::vec3(0, 0, 1), glm::vec3(0, 0, -1)}) {
        EXPECT_EQ(unpack_oct2x8(pack_oct2x8(axis)), axis);
    }
    EXPECT_EQ(pack_oct2x8({1, 0, 0}), 0x7FU) << "x is in the low bits";
    EXPECT_NEAR(glm::length(unpack_oct2x8(0x8080U)), 1.0F, 1e-6F) << "−128 counts as −1";
}

/// What is sent of a normal of 16 bits a component is as good as what is made from the direction itself.
TEST(CoarseNormals, TurnDirectionsByLessThanTheStatedBound) {
    std::mt19937 random(3);
    Plane plane{PlaneSemantic::kNormal, PlaneFormat::kOct2x16, 256, 256, {}};
    plane.bytes.resize(std::size_t{4} * 256 * 256);
    std::ranges::generate(plane.bytes, [&] { return static_cast<std::byte>(random()); });
    const std::vector<glm::vec3> before = unpack_plane(plane);
    const std::vector<glm::vec3> after = unpack_plane(coarse_normals(plane));
    const std::vector<glm::vec3> arrived = unpack_plane(fine_normals(coarse_normals(plane)));
    for (std::size_t i = 0; i < before.size(); ++i) {
        ASSERT_LT(glm::length(after[i] - before[i]), 0.01745F) << i; // 1°
        ASSERT_LT(glm::length(arrived[i] - after[i]), 0.00007F) << i; // 0.004°, as of OCT2X16
    }
}

TEST(UnpackPlane, ReadsEachFormat) {
    const auto plane = [](PlaneFormat format, std::vector<std::uint8_t> bytes) {
        Plane result{PlaneSemantic::kColour, format, 1, 1, {}};
        result.bytes.resize(bytes.size());
        std::memcpy(result.bytes.data(), bytes.data(), bytes.size());
        return result;
    };
    EXPECT_EQ(unpack_plane(plane(PlaneFormat::kF32, {0, 0, 0xC0, 0x3F})).front(), glm::vec3(1.5F));
    EXPECT_EQ(unpack_plane(plane(PlaneFormat::kRg8, {255, 51})).front(), glm::vec3(1.0F, 0.2F, 0.0F));
    EXPECT_EQ(unpack_plane(plane(PlaneFormat::kRgb8, {255, 0, 0})).front(), glm::vec3(1.0F, 0.0F, 0.0F));
    EXPECT_NEAR(unpack_plane(plane(PlaneFormat::kRgb8, {0, 188, 0})).front().y, 0.5029F, 1e-4F);
    EXPECT_EQ(unpack_plane(plane(PlaneFormat::kOct2x16, {0, 0, 0xFF, 0x7F})).front(), glm::vec3(0, 1, 0));
    EXPECT_EQ(unpack_plane(plane(PlaneFormat::kOct2x8, {0, 0x81})).front(), glm::vec3(0, -1, 0));
    EXPECT_EQ(unpack_plane(plane(PlaneFormat::kR11G11B10F, {0xC0, 0x03, 0, 0})).front(), glm::vec3(1, 0, 0));
    EXPECT_THROW(unpack_plane(plane(PlaneFormat::kU32, {0, 0, 0, 0})), std::logic_error);
    EXPECT_THROW(unpack_plane(plane(PlaneFormat::kF32, {0, 0})), std::logic_error);
}

} // namespace
} // namespace fieldcast::image
