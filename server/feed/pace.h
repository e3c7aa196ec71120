// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

namespace fieldcast::feed {

/// Limits one subscriber to a frame rate of its own. A frame is identified by the time at which it was begun, so that
/// the feed, which orders it, and the session, which takes it, decide alike. Not thread-safe.
class Pace {
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Interval = std::chrono::nanoseconds;

    Pace() = default; ///< no cap: always due
    explicit Pace(Interval interval) : interval_(interval) {}

    /// Whether a frame begun at `begin` is not too early.
    bool is_due(TimePoint begin) const { return begin >= earliest(); }

    /// Earliest begin of the next frame: a quarter of an interval before it is due, since frames are not evenly spaced.
    TimePoint earliest() const { return due_ ? *due_ - step() / 4 : TimePoint(); }

    /// When the next frame is due; the origin of the clock if none was taken: at once.
    TimePoint due() const { return due_.value_or(TimePoint()); }

    /// A frame begun at `begin` is taken.
    void take(TimePoint begin) {
        if (interval_) {
            const bool goes_on = due_ && begin < *due_ + step();
            due_ = (goes_on ? *due_ : begin) + step();
        }
    }

private:
    TimePoint::duration step() const { return std::chrono::duration_cast<TimePoint::duration>(*interval_); }

    std::optional<Interval> interval_; ///< unset: no cap
    std::optional<TimePoint> due_;     ///< unset: no frame was taken yet
};

} // namespace fieldcast::feed
