// SPDX-License-Identifier: Apache-2.0
#include "core/timing/frame_timing.h"

#include <algorithm>
#include <array>

namespace fieldcast::timing {

namespace {

// Clocks count from boot, so a time beyond 70 years is implausible. The limit keeps sums from overflowing.
constexpr std::int64_t kLatestNs = INT64_MAX / 4;

} // namespace

std::string_view to_text(Outcome outcome) {
    constexpr std::array<std::string_view, 6> kNames{"unacknowledged", "decoded", "shown",
                                                     "superseded",     "failed",  "aborted"};
    return kNames.at(static_cast<std::size_t>(outcome));
}

std::int64_t on_our_clock(std::int64_t time_ns, std::int64_t offset_ns) {
    const bool is_plausible =
        time_ns > 0 && time_ns <= kLatestNs && offset_ns >= -kLatestNs && offset_ns <= kLatestNs;
    return is_plausible ? std::max<std::int64_t>(time_ns + offset_ns, 0) : 0;
}

} // namespace fieldcast::timing
