// SPDX-License-Identifier: Apache-2.0
// Table-driven CRC, eight bytes per step.
// Follows: M. E. Kounavis, F. L. Berry. Novel Table Lookup-Based Algorithms for High-Performance CRC Generation.
// IEEE Transactions on Computers, 2008. Section 4 (slicing-by-8).
#include "core/codec/crc32c.h"

#include <array>

namespace fieldcast::codec {

namespace {

constexpr std::uint32_t kPolynomial = 0x82F63B78; // reflected: bit 31 is x^0

using Table = std::array<std::uint32_t, 256>;

/// tables[k][b]: contribution of byte b, followed by k zero bytes, to the CRC.
constexpr std::array<Table, 8> make_tables() {
    std::array<Table, 8> tables{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        std::uint32_t crc = byte;
        for (int bit = 0; bit < 8; ++bit) {
            crc = (crc >> 1) ^ ((crc & 1) != 0 ? kPolynomial : 0);
        }
        tables[0][byte] = crc;
    }
    for (std::size_t k = 1; k < 8; ++k) {
        for (std::size_t byte = 0; byte < 256; ++byte) {
            const std::uint32_t before = tables[k - 1][byte];
            tables[k][byte] = (before >> 8) ^ tables[0][before & 0xFF];
        }
    }
    return tables;
}

constexpr auto kTables = make_tables();

/// All ones if `bit` is 1, else 0.
constexpr std::uint32_t mask_of(std::uint32_t bit) {
    return 0U - bit;
}

constexpr std::uint32_t times_x(std::uint32_t a) {
    return (a >> 1) ^ (kPolynomial & mask_of(a & 1));
}

/// Product of two polynomials modulo the CRC polynomial. Without branches: the bits are random, half of the branches
/// would be mispredicted, and each client's frame takes hundreds of products.
constexpr std::uint32_t multiply(std::uint32_t a, std::uint32_t b) {
    std::uint32_t product = 0;
    for (int bit = 0; bit < 32; ++bit, a <<= 1) {
        product ^= b & mask_of(a >> 31);
        b = times_x(b);
    }
    return product;
}

/// powers[k] = x^(8 · 2^k): factor by which 2^k zero bytes multiply a CRC.
constexpr std::array<std::uint32_t, 64> make_powers() {
    std::array<std::uint32_t, 64> powers{};
    powers[0] = 0x80000000U >> 8;
    for (std::size_t k = 1; k < powers.size(); ++k) {
        powers[k] = multiply(powers[k - 1], powers[k - 1]);
    }
    return powers;
}

constexpr auto kPowers = make_powers();

std::uint32_t load_u32(const std::byte* bytes) {
    std::uint32_t value = 0;
    for (unsigned i = 0; i < 4; ++i) {
        value |= std::to_integer<std::uint32_t>(bytes[i]) << (8 * i);
    }
    return value;
}

} // namespace

std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t previous) {
    std::uint32_t crc = ~previous;
    const std::byte* at = bytes.data();
    std::size_t left = bytes.size();
    for (; left >= 8; left -= 8, at += 8) {
        const std::uint32_t low = load_u32(at) ^ crc;
        const std::uint32_t high = load_u32(at + 4);
        crc = kTables[7][low & 0xFF] ^ kTables[6][(low >> 8) & 0xFF] ^ kTables[5][(low >> 16) & 0xFF] ^
              kTables[4][low >> 24] ^ kTables[3][high & 0xFF] ^ kTables[2][(high >> 8) & 0xFF] ^
              kTables[1][(high >> 16) & 0xFF] ^ kTables[0][high >> 24];
    }
    for (; left > 0; --left, ++at) {
        crc = (crc >> 8) ^ kTables[0][(crc ^ std::to_integer<std::uint32_t>(*at)) & 0xFF];
    }
    return ~crc;
}

std::uint32_t crc32c_combine(std::uint32_t first, std::uint32_t second, std::uint64_t second_bytes) {
    for (std::size_t k = 0; second_bytes != 0; ++k, second_bytes >>= 1) {
        if ((second_bytes & 1) != 0) {
            first = multiply(kPowers[k], first);
        }
    }
    return first ^ second;
}

} // namespace fieldcast::codec
