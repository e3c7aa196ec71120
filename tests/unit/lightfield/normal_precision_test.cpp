// SPDX-License-Identifier: Apache-2.0
// tests/unit/image/packing_test.cpp has what the rounding does to directions.
#include "core/lightfield/normal_precision.h"

#include <cstring>
#include <gtest/gtest.h>
#include <stdexcept>

namespace fieldcast {
namespace {

Plane fine_plane(std::int16_t x, std::int16_t y) {
    Plane plane{PlaneSemantic::kNormal, PlaneFormat::kOct2x16, 1, 1, std::vector<std::byte>(4)};
    std::memcpy(plane.bytes.data(), &x, 2);
    std::memcpy(&plane.bytes[2], &y, 2);
    return plane;
}

int component(const Plane& coarse, std::size_t i) {
    return static_cast<std::int8_t>(std::to_integer<std::uint8_t>(coarse.bytes[i]));
}

TEST(NormalPrecision, RoundsToTheNearestOf255) {
    // One step of 1/127 is 258.008 of 1/32767; half of it 129.004.
    for (const auto& [fine, coarse] :
         {std::pair(0, 0), std::pair(129, 0), std::pair(130, 1), std::pair(-129, 0), std::pair(-130, -1),
          std::pair(258, 1), std::pair(32767, 127), std::pair(-32767, -127), std::pair(-32768, -127)}) {
        const Plane result = coarse_normals(fine_plane(static_cast<std::int16_t>(fine), 258));
        EXPECT_EQ(component(result, 0), coarse) << fine;
        EXPECT_EQ(component(result, 1), 1) << "y is in the high bits";
    }
}

TEST(NormalPrecision, KeepsMeaningAndSize) {
    Plane plane{PlaneSemantic::kNormal, PlaneFormat::kOct2x16, 3, 2, std::vector<std::byte>(24)};
    const Plane coarse = coarse_normals(plane);
    EXPECT_EQ(coarse.format, PlaneFormat::kOct2x8);
    EXPECT_EQ(coarse.bytes.size(), plane_bytes(PlaneFormat::kOct2x8, 3, 2));
    EXPECT_EQ(fine_normals(coarse), plane) << "nothing stays nothing";
}

TEST(NormalPrecision, GoingUpAndDownAgainChangesNothing) {
    Plane coarse{PlaneSemantic::kNormal, PlaneFormat::kOct2x8, 255, 255, {}};
    for (int y = -127; y <= 127; ++y) {
        for (int x = -127; x <= 127; ++x) {
            coarse.bytes.push_back(static_cast<std::byte>(x));
            coarse.bytes.push_back(static_cast<std::byte>(y));
        }
    }
    EXPECT_EQ(coarse_normals(fine_normals(coarse)), coarse);
}

TEST(NormalPrecision, OtherFormatsAreABug) {
    const Plane plane = fine_plane(1, 2);
    EXPECT_THROW(coarse_normals(coarse_normals(plane)), std::logic_error);
    EXPECT_THROW(fine_normals(plane), std::logic_error);
}

} // namespace
} // namespace fieldcast
