// SPDX-License-Identifier: Apache-2.0
#include "client/load/due_schedule.h"

#include <algorithm>

namespace fieldcast::client::load {

namespace {

constexpr std::int64_t kNsPerUs = 1000;

} // namespace

std::int64_t DueSchedule::answer(std::int64_t pose_ns, std::int64_t visible_ns, const Window& window,
                                 LatencyHistogram& latencies) {
    std::int64_t longest_us = 0;
    const std::int64_t until_ns = std::min(pose_ns, visible_ns); // clocks agree to within half a round trip only
    for (; next_ns_ <= until_ns; next_ns_ += period_ns_) {
        const std::int64_t latency_us = (visible_ns - next_ns_) / kNsPerUs;
        longest_us_ = std::max(longest_us_, latency_us);
        if (window.contains(next_ns_)) {
            latencies.add(latency_us);
            longest_us = std::max(longest_us, latency_us);
        }
    }
    return longest_us;
}

std::uint64_t DueSchedule::cut_off(std::int64_t now_ns, const Window& window, LatencyHistogram& latencies) {
    std::uint64_t count = 0;
    for (; now_ns - next_ns_ > longest_us_ * kNsPerUs; next_ns_ += period_ns_) {
        if (window.contains(next_ns_)) {
            latencies.add((now_ns - next_ns_) / kNsPerUs);
            ++count;
        }
    }
    return count;
}

} // namespace fieldcast::client::load
