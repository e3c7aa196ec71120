// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"

#include <gmock/gmock.h>

namespace fieldcast {
namespace {

TEST(Assert, NamesPlaceAndConditionInEveryBuildType) {
    const auto fail = [](int views) { FC_ASSERT(views <= 72, "grids are limited"); };
    EXPECT_NO_THROW(fail(72));
    try {
        fail(73);
        FAIL() << "did not throw";
    } catch (const std::logic_error& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("error_test.cpp:"));
        EXPECT_THAT(error.what(), testing::HasSubstr("grids are limited (views <= 72)"));
    }
}

TEST(Decoded, CarriesAValueOrAMessage) {
    const auto half = [](int value) -> Decoded<int> {
        return value % 2 == 0 ? Decoded<int>(value / 2) : decode_error("odd");
    };
    EXPECT_EQ(half(4).value(), 2);
    EXPECT_EQ(half(3).error().message, "odd");
}

} // namespace
} // namespace fieldcast
