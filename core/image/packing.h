// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/plane.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace fieldcast::image {

/// Three unsigned floats in one word (PlaneFormat::kR11G11B10F): 5 exponent bits each and 6, 6, 5 mantissa bits.
/// Every value is also a half. Packing rounds to nearest, ties to even; negative values and NaN become 0, values
/// above the largest finite number (65024, 65024, 64512) become that number.
std::uint32_t pack_r11g11b10f(const glm::vec3& rgb);
glm::vec3 unpack_r11g11b10f(std::uint32_t packed);

/// Unit vector in one word (PlaneFormat::kOct2x16). Packing rounds to nearest: the angular error is below 0.004°.
std::uint32_t pack_oct2x16(const glm::vec3& direction);
glm::vec3 unpack_oct2x16(std::uint32_t packed); ///< unit length for every word

/// The same in PlaneFormat::kOct2x8; the angular error of a direction rounded to it is below 1°.
std::uint32_t pack_oct2x8(const glm::vec3& direction);
glm::vec3 unpack_oct2x8(std::uint32_t packed); ///< unit length for every word of 16 bits

/// Pixels of a plane as linear numbers, row-major: kR11G11B10F as RGB, kOct2x16 and kOct2x8 as a direction, kRgb8 as
/// linear RGB in 0 … 1 after the sRGB curve is undone, kRg8 as (x, y, 0) in 0 … 1, kF32 and kR16 as (value, value,
/// value). Not for kU32, whose values are identifiers.
std::vector<glm::vec3> unpack_plane(const Plane& plane);

} // namespace fieldcast::image
