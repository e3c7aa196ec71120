// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/tally.h"

#include <chrono>
#include <cstdint>

namespace fieldcast::client::load {

/// The open model: at every due moment, on a schedule that no server can slow down, a viewer wants to see the world as
/// it is then. Its latency ends with the first frame whose pose was sampled at that moment or later. So a stall of ten
/// seconds at ten frames per second counts a hundred times, as 10.0, 9.9, 9.8 … seconds, although it delays one frame.
class DueSchedule {
public:
    /// Moments `first_ns`, `first_ns + period`, …; on the client's steady clock.
    DueSchedule(std::int64_t first_ns, std::chrono::nanoseconds period)
        : next_ns_(first_ns), period_ns_(period.count()) {}

    /// A frame posed at `pose_ns` became visible at `visible_ns`: answers every moment up to `pose_ns`. Latencies of
    /// moments in the window are added to `latencies`. Returns the longest of them, 0 if there was none.
    std::int64_t answer(std::int64_t pose_ns, std::int64_t visible_ns, const Window& window,
                        LatencyHistogram& latencies);

    /// The end: moments that have waited longer than any answered one did were cut off in a stall. They are added with
    /// the time they have waited, which is less than their latency. Returns how many.
    std::uint64_t cut_off(std::int64_t now_ns, const Window& window, LatencyHistogram& latencies);

private:
    std::int64_t next_ns_;
    std::int64_t period_ns_;
    std::int64_t longest_us_ = 0; ///< of all answers
};

} // namespace fieldcast::client::load
