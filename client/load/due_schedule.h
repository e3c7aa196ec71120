// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/tally.h"

#include <chrono>
#include <cstdint>

namespace fieldcast::client::load {

/// Latencies of an open load model: due moments follow a fixed schedule that no server can slow down. The latency of a
/// due moment ends with the first frame whose pose was sampled at that moment or later. A stall of ten seconds at ten
/// frames per second thus counts a hundred times, as 10.0, 9.9, 9.8 … seconds, although it delays one frame only.
class DueSchedule {
public:
    /// Due moments are `first_ns`, `first_ns + period`, … on the client's steady clock.
    DueSchedule(std::int64_t first_ns, std::chrono::nanoseconds period)
        : next_ns_(first_ns), period_ns_(period.count()) {}

    /// A frame whose pose was sampled at `pose_ns` became visible at `visible_ns`; it ends every due moment up to
    /// `pose_ns`. Adds the latencies of due moments in the window to `latencies`. Returns the longest of them, or 0.
    std::int64_t answer(std::int64_t pose_ns, std::int64_t visible_ns, const Window& window,
                        LatencyHistogram& latencies);

    /// Ends the schedule. Due moments that have waited longer than the longest latency so far were cut off in a stall:
    /// they are added with the time that they have waited, a lower bound of their latency. Returns their number.
    std::uint64_t cut_off(std::int64_t now_ns, const Window& window, LatencyHistogram& latencies);

private:
    std::int64_t next_ns_;
    std::int64_t period_ns_;
    std::int64_t longest_us_ = 0; ///< longest latency so far
};

} // namespace fieldcast::client::load
