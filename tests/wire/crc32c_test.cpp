// SPDX-License-Identifier: Apache-2.0
#include "core/codec/crc32c.h"

#include <array>
#include <gtest/gtest.h>
#include <string_view>
#include <vector>

namespace fieldcast::codec {
namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

// Check values: RFC 3720, appendix B.4, and the usual "123456789".
TEST(Crc32c, MatchesPublishedValues) {
    EXPECT_EQ(crc32c({}), 0U);
    EXPECT_EQ(crc32c(bytes_of("123456789")), 0xE3069283U);
    EXPECT_EQ(crc32c(std::vector<std::byte>(32)), 0x8A9136AAU);
    EXPECT_EQ(crc32c(std::vector<std::byte>(32, std::byte{0xFF})), 0x62A8AB43U);
    std::array<std::byte, 32> ascending{};
    for (std::size_t i = 0; i < ascending.size(); ++i) {
        ascending[i] = static_cast<std::byte>(i);
    }
    EXPECT_EQ(crc32c(ascending), 0x46DD794EU);
}

TEST(Crc32c, ContinuesAndCombinesAtEverySplit) {
    const std::string_view text = "The quick brown fox jumps over the lazy dog, twice.";
    const std::uint32_t whole = crc32c(bytes_of(text));
    for (std::size_t split = 0; split <= text.size(); ++split) {
        const auto first = bytes_of(text.substr(0, split));
        const auto second = bytes_of(text.substr(split));
        EXPECT_EQ(crc32c(second, crc32c(first)), whole) << split;
        EXPECT_EQ(crc32c_combine(crc32c(first), crc32c(second), second.size()), whole) << split;
    }
}

TEST(Crc32c, CombinesLongStrings) {
    std::vector<std::byte> bytes(300'001);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        bytes[i] = static_cast<std::byte>(i * 2654435761U >> 24);
    }
    const auto first = std::span(bytes).first(1234);
    const auto second = std::span(bytes).subspan(1234);
    EXPECT_EQ(crc32c_combine(crc32c(first), crc32c(second), second.size()), crc32c(bytes));
}

} // namespace
} // namespace fieldcast::codec
