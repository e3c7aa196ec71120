// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/session/credits.h"

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

namespace fieldcast::session {

/// What one acknowledged frame says about the way to the client.
struct LinkSample {
    std::uint64_t bytes = 0;
    std::chrono::nanoseconds queue_delay{
        0}; ///< time on the way beyond the smallest round trip: waiting and transmission
};

/// Measures how long frames are on the way to one client, from their acknowledgements.
class LinkMeter {
public:
    using Nanoseconds = std::chrono::nanoseconds;

    /// The first chunk of a frame is handed to the transport.
    void begun(FrameKey key, std::uint64_t bytes, TimePoint now);
    void aborted(FrameKey key);

    /// The client has handled the frame, having decoded for `decode_time`. No sample if the frame was begun behind one
    /// of an earlier epoch: it has waited for what that epoch left on the way.
    std::optional<LinkSample> acknowledged(FrameKey key, Nanoseconds decode_time, TimePoint now);

    /// Another measurement of the round trip, such as that of time synchronisation, which has no large frame in it.
    void add_round_trip(Nanoseconds round_trip, TimePoint now);

    /// Smallest of the last 30 to 60 s.
    std::optional<Nanoseconds> base_round_trip() const;

private:
    struct Frame {
        FrameKey key;
        std::uint64_t bytes = 0;
        TimePoint begun;
        bool is_behind_old_epoch = false;
    };
    std::deque<Frame> frames_; ///< on the way, oldest first; at most kMaxCredits
    std::optional<Nanoseconds> window_min_;
    std::optional<Nanoseconds> previous_window_min_;
    TimePoint window_begin_{};
};

} // namespace fieldcast::session
