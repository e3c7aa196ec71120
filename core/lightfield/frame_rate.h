// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

namespace fieldcast {

/// The slowest rate that a channel may have and a client may ask for. Slower, nobody could tell it from silence.
inline constexpr float kMinFramesPerSecond = 0.1F;
inline constexpr float kMaxFramesPerSecond = 240.0F; ///< of a channel

/// Of a channel.
constexpr bool is_frame_rate(float frames_per_second) {
    return frames_per_second >= kMinFramesPerSecond && frames_per_second <= kMaxFramesPerSecond;
}

/// A bound that a client sets; 0: none. Finite.
constexpr bool is_rate_bound(float frames_per_second) {
    return frames_per_second == 0.0F || (frames_per_second >= kMinFramesPerSecond &&
                                         frames_per_second <= std::numeric_limits<float>::max());
}

} // namespace fieldcast
