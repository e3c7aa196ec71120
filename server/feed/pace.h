// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

namespace fieldcast::feed {

/// Keeps somebody to a frame rate of its own. Frames are told apart by when they were begun, so that who asks for them
/// and who takes them agree.
class Pace {
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Interval = std::chrono::nanoseconds;

    Pace() = default; ///< no cap: always due
    explicit Pace(Interval interval) : interval_(interval) {}

    /// Whether a frame that is begun at `begin` is not too soon.
    bool is_due(TimePoint begin) const { return begin >= earliest(); }

    /// When the next one is not too soon: a quarter early, since frames of a channel are not evenly spaced.
    TimePoint earliest() const { return due_ ? *due_ - step() / 4 : TimePoint(); }

    /// When the next one is due; long ago: at once.
    TimePoint due() const { return due_.value_or(TimePoint()); }

    /// A frame that is begun at `begin` is taken.
    void take(TimePoint begin) {
        if (interval_) {
            const bool goes_on = due_ && begin < *due_ + step();
            due_ = (goes_on ? *due_ : begin) + step();
        }
    }

private:
    TimePoint::duration step() const { return std::chrono::duration_cast<TimePoint::duration>(*interval_); }

    std::optional<Interval> interval_; ///< unset: no cap
    std::optional<TimePoint> due_;     ///< unset: nothing was taken yet
};

} // namespace fieldcast::feed
