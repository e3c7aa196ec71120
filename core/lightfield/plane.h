// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fieldcast {

/// What a plane means. Values are on the wire: never renumber.
enum class PlaneSemantic : std::uint8_t {
    kDiffuse = 1,  ///< demodulated diffuse illumination, linear Rec. 709, unexposed
    kSpecular = 2, ///< demodulated specular illumination
    kDepth = 3,    ///< view depth (−Z), metres; infinity where nothing was hit
    kNormal = 4,   ///< shading normal, world space, octahedral
    kId = 5,       ///< instance << 12 | material; 0xFFFFFFFF where nothing was hit
    kMaterial = 6, ///< roughness, metallic
    kColour = 7,   ///< display-referred sRGB of a finished view, or of the source with its guard band
    kInverseDepth = 20,         ///< 1 / view depth in units of FrameHeader::inverse_depth_unit; 0 where nothing was hit
    kResidualColour = 21,       ///< as kColour, of ResidualLayer
    kResidualInverseDepth = 22, ///< as kInverseDepth, of ResidualLayer
    kTotalLight = 30,           ///< illumination that, taken for both kDiffuse and kSpecular, shows the same
};

/// How one pixel is stored, little-endian. Values are on the wire: never renumber.
enum class PlaneFormat : std::uint8_t {
    kR11G11B10F = 1, ///< u32: unsigned floats with 6, 6 and 5 mantissa bits, red in the low bits
    kF32 = 2,        ///< IEEE float
    kOct2x16 = 3,    ///< u32: octahedral x in the low, y in the high 16 bits, snorm
    kU32 = 4,
    kRg8 = 5,  ///< 2 bytes, unorm
    kRgb8 = 6, ///< 3 bytes, sRGB
    kR16 = 20,   ///< u16
    kOct2x8 = 30, ///< u16: octahedral x in the low, y in the high 8 bits, snorm
};

std::uint32_t bytes_per_pixel(PlaneFormat format); ///< 0 for a value that is not a format

/// Limits for anything that comes from outside.
inline constexpr std::uint32_t kMaxPlaneSide = 16384;
inline constexpr std::uint64_t kMaxPlaneBytes = 256ULL << 20;

/// An image in wire precision: `height_px` rows of `width_px` pixels, tightly packed.
struct Plane {
    PlaneSemantic semantic = PlaneSemantic::kColour;
    PlaneFormat format = PlaneFormat::kRgb8;
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    std::vector<std::byte> bytes;

    bool operator==(const Plane&) const = default;
};

/// Size of a plane's pixels, bytes; empty planes have 0.
std::uint64_t plane_bytes(PlaneFormat format, std::uint32_t width_px, std::uint32_t height_px);

} // namespace fieldcast
