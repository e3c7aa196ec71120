// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image_file.h"
#include "core/lightfield/plane.h"

namespace fieldcast::image {

// Comparisons of two images of one size. RMSE, PSNR and SSIM take display-referred values in 0 … 1, as `display_image`
// gives them; the reference comes second everywhere.

/// clamp(exposure · linear, 0, 1) through the sRGB curve. The metrics of the paper are computed on such images here.
RgbF32 display_image(const RgbF32& linear, float exposure);

/// Bytes of a kRgb8 plane divided by 255, the sRGB curve kept.
RgbF32 display_image(const Plane& rgb);

/// Root of the mean squared difference over pixels and channels.
double rmse(const RgbF32& image, const RgbF32& reference);

/// −20 log10(RMSE), dB; infinity for equal images.
double psnr_db(const RgbF32& image, const RgbF32& reference);

/// Mean structural similarity of the Rec. 709 luma with an 11×11 Gaussian window of σ = 1.5 px, K1 = 0.01, K2 = 0.03,
/// range 1 and population covariance, over the pixels whose window lies inside. Images are at least 11×11.
double ssim(const RgbF32& image, const RgbF32& reference);

/// Estimates rmse() and ssim() against the reference that `first` and `second` would be without their noise. The two
/// show the same and differ by independent noise only, so products of one with the other are free of that noise, and
/// squares of their mean are not. (x − a)·(x − b) therefore replaces (x − r)², and the covariance of a and b, if it is
/// positive, replaces the variance of r. The shift of the mean that the sRGB curve causes with noise remains. The noise
/// of `image` must be independent of theirs.
double rmse_without_noise(const RgbF32& image, const RgbF32& first, const RgbF32& second);
double ssim_without_noise(const RgbF32& image, const RgbF32& first, const RgbF32& second);

/// Mean of (x − r)² / (r² + 0.01) over pixels and channels of linear images.
double relative_mse(const RgbF32& image, const RgbF32& reference);

} // namespace fieldcast::image
