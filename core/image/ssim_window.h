// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>

namespace fieldcast::image {

// Definitions that all structural similarities here share.

inline constexpr std::size_t kSsimRadius = 5; // 3.5 σ, rounded: 11 taps
using SsimTaps = std::array<double, 2 * kSsimRadius + 1>;

/// Gaussian of σ = 1.5 that sums to 1.
const SsimTaps& ssim_taps();

/// Rec. 709 luma of a display-referred colour.
double luma(const glm::vec3& display);

/// Weighted means over a window of two images x and y and of their products.
struct WindowMeans {
    double x = 0.0;
    double y = 0.0;
    double xx = 0.0;
    double yy = 0.0;
    double xy = 0.0;
};

/// Structural similarity of one window: K1 = 0.01, K2 = 0.03, range 1, population covariance.
double ssim_of(const WindowMeans& means);

} // namespace fieldcast::image
