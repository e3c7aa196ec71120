// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/rgba8.h"
#include "core/lightfield/plane.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace fieldcast::image {

/// Checked against what the header of a file claims, before pixels are decoded.
struct ImageLimits {
    std::uint64_t max_pixels = 1ULL << 26;
};

/// Linear RGB.
struct RgbF32 {
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    std::vector<glm::vec3> pixels; ///< row 0 on top
};

/// Decodes PNG, JPEG or WebP, recognised by the first bytes. 16-bit and grey images are converted, missing alpha is
/// 255; no colour conversion, no rotation, alpha stays unassociated. `name` is used in messages.
/// Thread-safe. Throws UserError.
Rgba8 decode_rgba8(std::span<const std::byte> bytes, const std::string& name, const ImageLimits& limits);

/// Reads .hdr and .exr (first part; channels R, G, B, or one channel as grey) as linear RGB.
/// NaN and negative values are refused, because they would spread through every estimate made from the image.
/// +infinity is what a half-float image holds where the light was too bright for it: clamped to 65504, the largest
/// half, and logged as a warning. Thread-safe. Throws UserError.
RgbF32 read_rgb_f32(const std::filesystem::path& file, const ImageLimits& limits);

/// Encodes a kRgb8 plane, or an image with alpha, as an sRGB PNG. Equal pixels give equal bytes.
std::vector<std::byte> encode_png(const Plane& rgb);
std::vector<std::byte> encode_png(const Rgba8& rgba);

/// Writes a PNG; the file appears complete or not at all. Throws std::system_error.
void write_png(const std::filesystem::path& file, const Plane& rgb);
void write_png(const std::filesystem::path& file, const Rgba8& rgba);

/// Of the numbers in a file: kHalf has 11 significant bits and ends at 65504, what is greater becomes infinite.
enum class ExrPrecision : std::uint8_t { kFloat, kHalf };

/// Writes linear RGB as an EXR. Of kFloat, read_rgb_f32 gives back exactly what was written. Throws std::system_error.
void write_exr(const std::filesystem::path& file, const RgbF32& rgb, ExrPrecision precision = ExrPrecision::kFloat);

} // namespace fieldcast::image
