// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image_file.h"

#include <span>

namespace fieldcast::image {

/// Order of the views of `epi_ssim`.
enum class ViewLine : std::uint8_t {
    kRow,    ///< left to right: slices are x–u
    kColumn, ///< top to bottom: slices are y–v
};

/// Structural similarity of epipolar plane images: of the slices that show how one line of pixels moves through a row
/// (or column) of views. In these, parallax makes slopes and inconsistent views make steps. The result is the mean over
/// all slices of an SSIM as `ssim` computes it (Rec. 709 luma, K1 = 0.01, K2 = 0.03, 11 Gaussian taps of σ = 1.5), but
/// with the window cut off and normalised at the first and last view, because there are fewer views than taps. The
/// images are display-referred, of one size, and have at least 11 pixels along the slice. There are as many references
/// as views, at least two.
double epi_ssim(std::span<const RgbF32> views, std::span<const RgbF32> references, ViewLine line);

} // namespace fieldcast::image
