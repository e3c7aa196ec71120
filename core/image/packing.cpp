// SPDX-License-Identifier: Apache-2.0
// Octahedral directions follow: Z. Cigolle, S. Donow, D. Evangelakos, M. Mara, M. McGuire, Q. Meyer. A Survey of
// Efficient Representations for Independent Unit Vectors. JCGT 3(2), 2014, section 3.
#include "core/image/packing.h"

#include "core/base/error.h"
#include "core/image/transfer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace fieldcast::image {

namespace {

constexpr int kExponentBias = 15;
constexpr std::uint32_t kLargestExponent = 30; // 31 is infinity and NaN

/// Unsigned float with 5 exponent and `mantissa_bits` bits.
std::uint32_t pack_unsigned_float(float value, int mantissa_bits) {
    const std::uint32_t largest = (kLargestExponent + 1U) << mantissa_bits;
    if (!(value > 0.0F)) {
        return 0; // negative or NaN
    }
    if (std::isinf(value)) {
        return largest - 1;
    }
    int exponent = 0;
    std::frexp(value, &exponent); // value = m · 2^exponent with m in [0.5, 1)
    const int biased = std::max(exponent - 1 + kExponentBias, 1);
    // In units of the last mantissa bit; denormals share the exponent of the smallest normal numbers.
    const float units = std::ldexp(value, mantissa_bits + kExponentBias - biased);
    const auto rounded = static_cast<std::uint32_t>(std::nearbyint(std::min(units, 4096.0F)));
    // The implicit leading 1 of a normal number carries into the exponent field, as does rounding up.
    const std::uint32_t packed = (static_cast<std::uint32_t>(biased - 1) << mantissa_bits) + rounded;
    return std::min(packed, largest - 1);
}

float unpack_unsigned_float(std::uint32_t bits, int mantissa_bits) {
    const std::uint32_t mantissa = bits & ((1U << mantissa_bits) - 1U);
    const std::uint32_t exponent = bits >> mantissa_bits & 31U;
    if (exponent > kLargestExponent) {
        return mantissa == 0 ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
    }
    const std::uint32_t leading = exponent == 0 ? 0U : 1U << mantissa_bits;
    const int biased = std::max(static_cast<int>(exponent), 1);
    return std::ldexp(static_cast<float>(leading + mantissa), biased - kExponentBias - mantissa_bits);
}

float sign_not_zero(float value) {
    return value < 0.0F ? -1.0F : 1.0F;
}

/// Folds the lower half of the octahedron out over the upper, and back: its own inverse.
glm::vec2 fold(const glm::vec2& p) {
    return {(1.0F - std::abs(p.y)) * sign_not_zero(p.x), (1.0F - std::abs(p.x)) * sign_not_zero(p.y)};
}

/// Packs a number into `bits` bits, 8 or 16.
std::uint32_t pack_snorm(float value, int bits) {
    const auto largest = static_cast<float>((1 << (bits - 1)) - 1);
    const float scaled = std::nearbyint(std::clamp(value, -1.0F, 1.0F) * largest);
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(scaled)) & ((1U << bits) - 1U);
}

/// Unpacks the low `bits` bits of `word`, 8 or 16.
float unpack_snorm(std::uint32_t word, int bits) {
    const auto value = static_cast<std::int32_t>(word << (32 - bits)) >> (32 - bits);
    return std::max(static_cast<float>(value) / static_cast<float>((1 << (bits - 1)) - 1), -1.0F);
}

/// Packs two components of `bits` bits each, x in the low ones.
std::uint32_t pack_octahedral(const glm::vec3& direction, int bits) {
    const float sum = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
    const glm::vec2 upper = glm::vec2(direction) / sum;
    const glm::vec2 p = direction.z < 0.0F ? fold(upper) : upper;
    return pack_snorm(p.x, bits) | pack_snorm(p.y, bits) << bits;
}

glm::vec3 unpack_octahedral(std::uint32_t packed, int bits) {
    const glm::vec2 p(unpack_snorm(packed, bits), unpack_snorm(packed >> bits, bits));
    const float z = 1.0F - std::abs(p.x) - std::abs(p.y);
    return glm::normalize(glm::vec3(z < 0.0F ? fold(p) : p, z));
}

std::array<float, 256> srgb_table() {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        table[i] = linear_from_srgb(static_cast<float>(i) / 255.0F);
    }
    return table;
}

std::uint32_t word_at(const Plane& plane, std::size_t pixel) {
    std::uint32_t word = 0;
    std::memcpy(&word, plane.bytes.data() + pixel * sizeof word, sizeof word);
    return word;
}

glm::vec3 unpack_pixel(const Plane& plane, std::size_t pixel) {
    static const std::array<float, 256> linear = srgb_table();
    const auto byte = [&](std::size_t position) { return std::to_integer<std::size_t>(plane.bytes[position]); };
    switch (plane.format) {
    case PlaneFormat::kR11G11B10F:
        return unpack_r11g11b10f(word_at(plane, pixel));
    case PlaneFormat::kOct2x16:
        return unpack_oct2x16(word_at(plane, pixel));
    case PlaneFormat::kF32:
        return glm::vec3(std::bit_cast<float>(word_at(plane, pixel)));
    case PlaneFormat::kRg8:
        return {static_cast<float>(byte(2 * pixel)) / 255.0F, static_cast<float>(byte(2 * pixel + 1)) / 255.0F, 0.0F};
    case PlaneFormat::kRgb8:
        return {linear[byte(3 * pixel)], linear[byte(3 * pixel + 1)], linear[byte(3 * pixel + 2)]};
    case PlaneFormat::kOct2x8:
        return unpack_oct2x8(static_cast<std::uint32_t>(byte(2 * pixel) | byte(2 * pixel + 1) << 8));
    case PlaneFormat::kR16:
        return glm::vec3(static_cast<float>(byte(2 * pixel) | byte(2 * pixel + 1) << 8));
    case PlaneFormat::kU32:
        break;
    }
    FC_ASSERT(false, "plane holds numbers");
    return {};
}

} // namespace

std::uint32_t pack_r11g11b10f(const glm::vec3& rgb) {
    return pack_unsigned_float(rgb.r, 6) | pack_unsigned_float(rgb.g, 6) << 11 | pack_unsigned_float(rgb.b, 5) << 22;
}

glm::vec3 unpack_r11g11b10f(std::uint32_t packed) {
    return {unpack_unsigned_float(packed & 0x7FFU, 6), unpack_unsigned_float(packed >> 11 & 0x7FFU, 6),
            unpack_unsigned_float(packed >> 22, 5)};
}

std::uint32_t pack_oct2x16(const glm::vec3& direction) {
    return pack_octahedral(direction, 16);
}

glm::vec3 unpack_oct2x16(std::uint32_t packed) {
    return unpack_octahedral(packed, 16);
}

std::uint32_t pack_oct2x8(const glm::vec3& direction) {
    return pack_octahedral(direction, 8);
}

glm::vec3 unpack_oct2x8(std::uint32_t packed) {
    return unpack_octahedral(packed, 8);
}

std::vector<glm::vec3> unpack_plane(const Plane& plane) {
    const std::size_t count = static_cast<std::size_t>(plane.width_px) * plane.height_px;
    FC_ASSERT(plane.bytes.size() == count * bytes_per_pixel(plane.format), "plane has all its pixels");
    std::vector<glm::vec3> pixels(count);
    for (std::size_t pixel = 0; pixel < count; ++pixel) {
        pixels[pixel] = unpack_pixel(plane, pixel);
    }
    return pixels;
}

} // namespace fieldcast::image
