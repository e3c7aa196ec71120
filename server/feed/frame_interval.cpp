// SPDX-License-Identifier: Apache-2.0
#include "server/feed/frame_interval.h"

#include "core/lightfield/frame_rate.h"

namespace fieldcast::feed {

std::chrono::nanoseconds frame_interval(float frames_per_second) {
    const bool is_slow = !(frames_per_second >= kMinFramesPerSecond); // also if it is NaN
    const double rate = static_cast<double>(is_slow ? kMinFramesPerSecond : frames_per_second);
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(1.0 / rate));
}

} // namespace fieldcast::feed
