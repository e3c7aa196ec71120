// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace fieldcast::session {

/// Qualities that lossy codecs are used with, ascending. They are few, so that clients with different wishes share
/// encodings.
inline constexpr std::array<std::uint8_t, 6> kQualityRungs{10, 25, 40, 55, 75, 90};

/// The best of kQualityRungs and `of_channel` that is not above `asked`, else the lowest rung. 0 asks for `of_channel`.
inline std::uint8_t quality_rung(std::uint32_t asked, std::uint8_t of_channel) {
    if (asked == 0) {
        return of_channel;
    }
    std::uint8_t best = kQualityRungs.front();
    for (const std::uint8_t rung : kQualityRungs) {
        best = rung <= asked ? rung : best;
    }
    return of_channel <= asked && of_channel > best ? of_channel : best;
}

} // namespace fieldcast::session
