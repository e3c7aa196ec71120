// SPDX-License-Identifier: Apache-2.0
#include "core/image/transfer.h"

#include <algorithm>
#include <cmath>

namespace fieldcast::image {

float srgb_from_linear(float linear) {
    if (linear >= 1.0F) {
        return 1.0F; // rounding of the formula gives a little less
    }
    const float x = linear < 0.0F ? 0.0F : linear; // keeps NaN
    return x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1.0F / 2.4F) - 0.055F;
}

float linear_from_srgb(float srgb) {
    const float x = std::clamp(srgb, 0.0F, 1.0F);
    return x <= 0.04045F ? x / 12.92F : std::pow((x + 0.055F) / 1.055F, 2.4F);
}

} // namespace fieldcast::image
