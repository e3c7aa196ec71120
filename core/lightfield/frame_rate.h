// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

namespace fieldcast {

/// Lowest frame rate of a channel, and lowest bound that a client may set. A slower stream looks like a stalled one.
inline constexpr float kMinFramesPerSecond = 0.1F;
inline constexpr float kMaxFramesPerSecond = 240.0F; ///< of a channel

/// Whether a channel may have this frame rate.
constexpr bool is_frame_rate(float frames_per_second) {
    return frames_per_second >= kMinFramesPerSecond && frames_per_second <= kMaxFramesPerSecond;
}

/// Whether a client may set this bound; 0: no bound. Bounds are finite.
constexpr bool is_rate_bound(float frames_per_second) {
    return frames_per_second == 0.0F || (frames_per_second >= kMinFramesPerSecond &&
                                         frames_per_second <= std::numeric_limits<float>::max());
}

} // namespace fieldcast
