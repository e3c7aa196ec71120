// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/pace.h"

#include <chrono>
#include <optional>

// Times at which a subscriber's selection counts.
namespace fieldcast::feed {

/// Whether a subscriber can begin to send one more frame.
struct Room {
    using TimePoint = std::chrono::steady_clock::time_point;

    /// Expected time at which the waiting frame is begun; it waits for credit or for the frame before. Empty: no frame
    /// waits, and the next one is begun or waits.
    std::optional<TimePoint> taken_until = std::nullopt;
};

/// Time span in which the selection of a subscriber counts, both ends inclusive.
struct Window {
    using TimePoint = Room::TimePoint;

    TimePoint from;
    TimePoint until;

    bool contains(TimePoint now) const { return from <= now && now <= until; }
};

/// Without room, a selection counts around the expected time of having room: a frame begun `lead` before is ready then
/// and replaces the waiting one. If that time passes, the selection does not count until the subscriber reports room.
inline Window window_of(const Room& room, const Pace& pace, std::chrono::steady_clock::duration lead) {
    if (room.taken_until) {
        return {.from = std::max(*room.taken_until - lead, pace.earliest()), .until = *room.taken_until + lead};
    }
    return {.from = pace.earliest(), .until = Window::TimePoint::max()};
}

} // namespace fieldcast::feed
