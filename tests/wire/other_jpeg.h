// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fieldcast::testing {

/// Files that other programs might write.
enum class JpegKind : std::uint8_t {
    kBaseline,         ///< with libjpeg's own tables: must be understood
    kSubsampled,       ///< 4:2:0
    kProgressive,      ///< many scans
    kScanPerComponent, ///< baseline, three scans: a decoder would have to hold the whole picture
    kArithmetic,
    kGrey, ///< one component
    kRgb,  ///< three components that are not Y, Cb and Cr
};

/// `rgb`: width_px · height_px pixels of 3 bytes.
std::vector<std::byte> other_jpeg(const std::vector<std::byte>& rgb, std::uint32_t width_px, std::uint32_t height_px,
                                  JpegKind kind);

} // namespace fieldcast::testing
