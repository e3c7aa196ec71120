// SPDX-License-Identifier: Apache-2.0
#include "server/feed/frame_interval.h"

#include <algorithm>

namespace fieldcast::feed {

std::chrono::nanoseconds frame_interval(float frames_per_second) {
    constexpr double kLongest_s = 86'400.0;
    const std::chrono::duration<double> seconds(std::min(1.0 / static_cast<double>(frames_per_second), kLongest_s));
    return std::chrono::duration_cast<std::chrono::nanoseconds>(seconds);
}

} // namespace fieldcast::feed
