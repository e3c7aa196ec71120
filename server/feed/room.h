// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/pace.h"

#include <chrono>
#include <optional>

// For which frames a subscriber counts.
namespace fieldcast::feed {

/// Whether a subscriber could begin to send one more frame.
struct Room {
    using TimePoint = std::chrono::steady_clock::time_point;

    /// A frame waits already, for credit or for the one before. It is expected to be begun at that time; empty: none
    /// waits, and a frame that comes is begun or waits in its place.
    std::optional<TimePoint> taken_until = std::nullopt;
};

/// When the selection of a subscriber counts, from and until inclusive.
struct Window {
    using TimePoint = Room::TimePoint;

    TimePoint from;
    TimePoint until;

    bool contains(TimePoint now) const { return from <= now && now <= until; }
};

/// Without room it counts around the time at which there will be some: frames that begin `lead` before are ready then,
/// so nothing is late and the frame that waits is replaced by a fresh one. If that time passes, nothing more is made for
/// it until it says that there is room.
inline Window window_of(const Room& room, const Pace& pace, std::chrono::steady_clock::duration lead) {
    if (room.taken_until) {
        return {.from = std::max(*room.taken_until - lead, pace.earliest()), .until = *room.taken_until + lead};
    }
    return {.from = pace.earliest(), .until = Window::TimePoint::max()};
}

} // namespace fieldcast::feed
