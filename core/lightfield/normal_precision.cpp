// SPDX-License-Identifier: Apache-2.0
// Octahedral components are rounded one by one: the fold of the octahedron is continuous, so that a small step in the
// plane is a small turn of the direction everywhere (core/image/packing.h has the mapping).
#include "core/lightfield/normal_precision.h"

#include "core/base/error.h"

#include <algorithm>
#include <cstring>

namespace fieldcast {

namespace {

constexpr int kFineOne = 32767; // 1 as snorm16
constexpr int kCoarseOne = 127; // 1 as snorm8

/// `value · to / from`, rounded to the nearest.
constexpr int rescaled(int value, int from, int to) {
    const int product = 2 * value * to;
    return (product >= 0 ? product + from : product - from) / (2 * from);
}

/// Converts every component of `plane` from a `From` to a `To`.
template <class From, class To> Plane converted(const Plane& plane, PlaneFormat format, int from_one, int to_one) {
    Plane result{plane.semantic, format, plane.width_px, plane.height_px, {}};
    const std::size_t count = plane.bytes.size() / sizeof(From);
    result.bytes.resize(count * sizeof(To));
    for (std::size_t i = 0; i < count; ++i) {
        From from{};
        std::memcpy(&from, &plane.bytes[i * sizeof from], sizeof from);
        const auto to = static_cast<To>(rescaled(std::max<int>(from, -from_one), from_one, to_one));
        std::memcpy(&result.bytes[i * sizeof to], &to, sizeof to);
    }
    return result;
}

} // namespace

Plane coarse_normals(const Plane& plane) {
    FC_ASSERT(plane.format == PlaneFormat::kOct2x16, "normals of 16 bits a component");
    return converted<std::int16_t, std::int8_t>(plane, PlaneFormat::kOct2x8, kFineOne, kCoarseOne);
}

Plane fine_normals(const Plane& plane) {
    FC_ASSERT(plane.format == PlaneFormat::kOct2x8, "normals of 8 bits a component");
    return converted<std::int8_t, std::int16_t>(plane, PlaneFormat::kOct2x16, kCoarseOne, kFineOne);
}

} // namespace fieldcast
