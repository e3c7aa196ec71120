// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace fieldcast::image {

/// IEC 61966-2-1 opto-electronic transfer: linear 0 … 1 to display-referred 0 … 1. Values outside are clamped, NaN
/// stays.
float srgb_from_linear(float linear);

/// The inverse.
float linear_from_srgb(float srgb);

} // namespace fieldcast::image
