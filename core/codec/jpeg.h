// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Baseline JPEG of 8-bit RGB without subsampling, by libjpeg-turbo. (Its newer interface, TurboJPEG, cannot set
// quantisation tables. The usual tables cost a quarter more bytes at the same SSIM of path-traced views.)
namespace fieldcast::codec {

/// Rows of pixels, 3 bytes each, tightly packed.
struct RgbSize {
    std::uint32_t width_px = 0;
    std::uint32_t row_count = 0;

    std::size_t bytes() const { return std::size_t{3} * width_px * row_count; }
};

/// Parameters of the quantisation tables.
struct JpegQuality {
    std::uint8_t quality = 75;        ///< 1 to 100, scales the tables as libjpeg does
    double step_at_quality_50 = 27.5; ///< of the mean of Y
    double step_growth = 0.04;        ///< per cycle of distance from the mean, relative
    double chroma_coarseness = 4;     ///< steps of Cb and Cr, relative to those of Y
};

/// For finished views. Path-traced pictures consist mostly of noise, so the steps grow little with the frequency.
inline constexpr JpegQuality kViewQuality{};
/// For light on a LightCurve. Its noise is gone; errors that grow with the frequency would blur its edges.
inline constexpr JpegQuality kLightQuality{.step_at_quality_50 = 9, .step_growth = 0, .chroma_coarseness = 5};

/// A whole JPEG file. `rgb` has size.bytes().
std::vector<std::byte> encode_jpeg(std::span<const std::byte> rgb, RgbSize size, JpegQuality quality);

/// Fills `rgb`, which has size.bytes(), from a file that must be a baseline JPEG of exactly that size: three components
/// of 8 bits without subsampling, Huffman coding, one scan, nothing after the end, no warnings. Nothing of the size of
/// the picture is allocated. On failure `rgb` is undefined.
Decoded<void> decode_jpeg(std::span<const std::byte> file, RgbSize size, std::span<std::byte> rgb);

} // namespace fieldcast::codec
