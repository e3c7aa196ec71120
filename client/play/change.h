// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/configure.h"

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

namespace fieldcast::client::play {

/// When to request a change of the running stream. One of the two is set.
struct ChangeMoment {
    std::optional<std::chrono::milliseconds> after{}; ///< since the first agreement of the run
    std::optional<std::uint64_t> frames{};            ///< number of received frames
};

/// A request for another configuration on the running stream.
struct Change {
    ChangeMoment moment;
    net::Request request; ///< complete, not only the differences
};

/// The changes of a run, in their order, and which one is next. Reconnects do not restart it.
class ChangeSchedule {
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    explicit ChangeSchedule(std::vector<Change> changes) : changes_(std::move(changes)) {}

    /// The request of the next change if it is due. Each is returned once.
    std::optional<net::Request> due(TimePoint now) {
        if (next_ >= changes_.size() || !begin_) {
            return std::nullopt;
        }
        const ChangeMoment& moment = changes_[next_].moment;
        const bool is_due =
            (moment.after && now - *begin_ >= *moment.after) || (moment.frames && frames_ >= *moment.frames);
        return is_due ? std::optional(changes_[next_++].request) : std::nullopt;
    }

    void agreed(TimePoint now) { begin_ = begin_.value_or(now); }
    void frame_arrived() { ++frames_; }

private:
    std::vector<Change> changes_;
    std::size_t next_ = 0;
    std::optional<TimePoint> begin_; ///< time of the first agreement
    std::uint64_t frames_ = 0;
};

} // namespace fieldcast::client::play
