// SPDX-License-Identifier: Apache-2.0
// Follows: Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli. Image Quality Assessment: From Error Visibility
// to Structural Similarity. IEEE TIP 13(4), 2004, section III.B, eq. 13.
#include "core/image/ssim_window.h"

#include <cmath>

namespace fieldcast::image {

namespace {

constexpr double kSigma = 1.5;
constexpr double kC1 = 0.01 * 0.01;
constexpr double kC2 = 0.03 * 0.03;

SsimTaps make_taps() {
    SsimTaps taps{};
    double sum = 0.0;
    for (std::size_t i = 0; i < taps.size(); ++i) {
        const double x = static_cast<double>(i) - static_cast<double>(kSsimRadius);
        taps[i] = std::exp(-0.5 * x * x / (kSigma * kSigma));
        sum += taps[i];
    }
    for (double& tap : taps) {
        tap /= sum;
    }
    return taps;
}

} // namespace

const SsimTaps& ssim_taps() {
    static const SsimTaps taps = make_taps();
    return taps;
}

double luma(const glm::vec3& display) {
    return 0.2126 * static_cast<double>(display.r) + 0.7152 * static_cast<double>(display.g) +
           0.0722 * static_cast<double>(display.b);
}

double ssim_of(const WindowMeans& means) {
    const double mxy = means.x * means.y;
    const double squares = means.x * means.x + means.y * means.y;
    const double variances = means.xx + means.yy - squares;
    const double covariance = means.xy - mxy;
    return (2.0 * mxy + kC1) * (2.0 * covariance + kC2) / ((squares + kC1) * (variances + kC2));
}

} // namespace fieldcast::image
