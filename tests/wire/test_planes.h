// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/codec/byte_filter.h"
#include "core/lightfield/plane.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <span>
#include <string>

namespace fieldcast::testing {

inline constexpr std::array kAllFormats{PlaneFormat::kR11G11B10F, PlaneFormat::kF32, PlaneFormat::kOct2x16,
                                        PlaneFormat::kU32,        PlaneFormat::kRg8, PlaneFormat::kRgb8,
                                        PlaneFormat::kR16,        PlaneFormat::kOct2x8};
/// One for each meaning: those of source frames.
inline constexpr std::span kUsualFormats = std::span(kAllFormats).first<kAllFormats.size() - 1>();

inline PlaneSemantic semantic_of(PlaneFormat format) {
    switch (format) {
    case PlaneFormat::kR11G11B10F:
        return PlaneSemantic::kDiffuse;
    case PlaneFormat::kF32:
        return PlaneSemantic::kDepth;
    case PlaneFormat::kOct2x16:
    case PlaneFormat::kOct2x8:
        return PlaneSemantic::kNormal;
    case PlaneFormat::kU32:
        return PlaneSemantic::kId;
    case PlaneFormat::kRg8:
        return PlaneSemantic::kMaterial;
    case PlaneFormat::kRgb8:
        return PlaneSemantic::kColour;
    case PlaneFormat::kR16:
        return PlaneSemantic::kInverseDepth;
    }
    return PlaneSemantic::kColour;
}

inline std::string name_of(PlaneFormat format) {
    switch (format) {
    case PlaneFormat::kR11G11B10F:
        return "r11g11b10f";
    case PlaneFormat::kF32:
        return "f32";
    case PlaneFormat::kOct2x16:
        return "oct2x16";
    case PlaneFormat::kU32:
        return "u32";
    case PlaneFormat::kRg8:
        return "rg8";
    case PlaneFormat::kRgb8:
        return "rgb8";
    case PlaneFormat::kR16:
        return "r16";
    case PlaneFormat::kOct2x8:
        return "oct2x8";
    }
    return "";
}

inline Plane empty_plane(PlaneFormat format, std::uint32_t width_px, std::uint32_t height_px) {
    const auto size = static_cast<std::size_t>(plane_bytes(format, width_px, height_px));
    return {semantic_of(format), format, width_px, height_px, std::vector<std::byte>(size)};
}

inline Plane random_plane(PlaneFormat format, std::uint32_t width_px, std::uint32_t height_px, std::uint32_t seed = 1) {
    Plane plane = empty_plane(format, width_px, height_px);
    std::mt19937 random(seed);
    for (std::byte& byte : plane.bytes) {
        byte = static_cast<std::byte>(random());
    }
    return plane;
}

/// Soft light with a hard edge: kR11G11B10F, from 0 to about 30.
inline Plane light_plane(std::uint32_t width_px, std::uint32_t height_px) {
    Plane plane = empty_plane(PlaneFormat::kR11G11B10F, width_px, height_px);
    for (std::uint32_t i = 0; i < width_px * height_px; ++i) {
        const std::uint32_t x = i % width_px;
        const std::uint32_t y = i / width_px;
        const std::uint32_t bits = x < width_px / 3 ? 0 : 640 + 8 * (x % 40) + 4 * (y % 20); // 1/32 and up
        const std::uint32_t pixel = bits | bits << 11 | bits / 2 << 22;
        std::memcpy(&plane.bytes[std::size_t{4} * i], &pixel, sizeof pixel);
    }
    return plane;
}

/// Green of a pixel of a kR11G11B10F plane: 64 are an octave.
inline int green_bits(const Plane& plane, std::size_t pixel) {
    std::uint32_t word = 0;
    std::memcpy(&word, &plane.bytes[4 * pixel], sizeof word);
    return static_cast<int>(word >> 11 & 0x7FF);
}

/// Compressible, and the same on every machine for ever: byte b of pixel (x, y) is 3x + 5y + 7b + (0 or 1).
inline Plane ramp_plane(PlaneFormat format, std::uint32_t width_px, std::uint32_t height_px, std::uint32_t seed = 0) {
    Plane plane = empty_plane(format, width_px, height_px);
    const std::uint32_t pixel_bytes = bytes_per_pixel(format);
    for (std::size_t i = 0; i < plane.bytes.size(); ++i) {
        const auto pixel = static_cast<std::uint32_t>(i / pixel_bytes);
        const auto b = static_cast<std::uint32_t>(i % pixel_bytes);
        const std::uint32_t noise = ((pixel + seed) * 2654435761U >> 16) & 1;
        plane.bytes[i] = static_cast<std::byte>(3 * (pixel % width_px) + 5 * (pixel / width_px) + 7 * b + noise);
    }
    return plane;
}

/// The filters of the first strips: files in tests/data/wire/v1 keep them readable.
inline codec::ByteFilter first_filter(PlaneFormat format) {
    using codec::Layout;
    using codec::Predictor;
    switch (format) {
    case PlaneFormat::kF32:
        return {Predictor::kLeft, Layout::kWords32, false};
    case PlaneFormat::kOct2x16:
    case PlaneFormat::kR16:
        return {Predictor::kGradient, Layout::kWords16, false};
    case PlaneFormat::kU32:
        return {Predictor::kNone, Layout::kBytes, false};
    case PlaneFormat::kR11G11B10F:
    case PlaneFormat::kRg8:
    case PlaneFormat::kOct2x8:
    case PlaneFormat::kRgb8:
        break;
    }
    return {Predictor::kGradient, Layout::kBytes, false};
}

} // namespace fieldcast::testing
