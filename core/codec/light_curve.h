// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

// Light as eight bits per channel, which codecs for pictures can encode. Part of the wire format: docs/protocol.md,
// "JPEG".
namespace fieldcast::codec {

/// Value x ≥ 0 ↔ sample round(255 · log(1 + x / knee) / log(1 + top / knee)). Far below the knee samples are
/// proportional to the light, far above it to its logarithm. The steps are thus equally visible on dark and on bright
/// surfaces. Nothing depends on a tone map.
struct LightCurve {
    float knee = 1.0F; ///< in units of the values
    float top = 1.0F;  ///< value of sample 255

    bool operator==(const LightCurve&) const = default;
};

inline constexpr std::size_t kLightCurveBytes = 8; ///< encoded

/// A curve for kR11G11B10F pixels up to their largest value. `exposure` is the factor that multiplies them for display.
LightCurve light_curve_for(std::span<const std::byte> pixels, float exposure);

std::array<std::byte, kLightCurveBytes> encode_curve(const LightCurve& curve);

/// Reads the first kLightCurveBytes of `bytes`.
Decoded<LightCurve> decode_curve(std::span<const std::byte> bytes);

/// kR11G11B10F pixels → 3 samples each. NaN becomes 0; values beyond the top, infinity included, become 255.
void samples_from_light(const LightCurve& curve, std::span<const std::byte> pixels, std::span<std::byte> samples);

/// 3 samples each → kR11G11B10F pixels, the nearest values; 0 stays exactly 0.
void light_from_samples(const LightCurve& curve, std::span<const std::byte> samples, std::span<std::byte> pixels);

} // namespace fieldcast::codec
