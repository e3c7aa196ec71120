// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/session/credits.h"

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

namespace fieldcast::session {

/// Measurement of the connection from one acknowledged frame.
struct LinkSample {
    std::uint64_t bytes = 0;
    std::chrono::nanoseconds queue_delay{0}; ///< time beyond the smallest round trip: queueing and transmission
};

/// Measures from acknowledgements how long frames take to reach one client. Not thread-safe.
class LinkMeter {
public:
    using Nanoseconds = std::chrono::nanoseconds;

    /// The first chunk of a frame is handed to the transport.
    void begun(FrameKey key, std::uint64_t bytes, TimePoint now);
    void aborted(FrameKey key); ///< the rest of the frame will not be sent

    /// The client has handled the frame and spent `decode_time` on it. Empty for a repetition, and if a frame of an
    /// earlier epoch was in flight when this one was begun: this one had to wait for it.
    std::optional<LinkSample> acknowledged(FrameKey key, Nanoseconds decode_time, TimePoint now);

    /// Another measurement of the round trip, such as that of time synchronisation, which transmits no large frame.
    void add_round_trip(Nanoseconds round_trip, TimePoint now);

    /// Smallest round trip of the last 30 to 60 s; unset before the first measurement.
    std::optional<Nanoseconds> base_round_trip() const;

private:
    struct Frame {
        FrameKey key;
        std::uint64_t bytes = 0;
        TimePoint begun;
        bool is_behind_old_epoch = false;
    };
    std::deque<Frame> frames_; ///< in flight, oldest first; at most kMaxCredits
    std::optional<Nanoseconds> window_min_;
    std::optional<Nanoseconds> previous_window_min_;
    TimePoint window_begin_{};
};

} // namespace fieldcast::session
