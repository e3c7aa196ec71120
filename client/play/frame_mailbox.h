// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/session.h"
#include "core/base/guarded.h"
#include "core/timing/frame_timing.h"

#include <condition_variable>
#include <memory>
#include <optional>
#include <stop_token>

namespace fieldcast::client::play {

/// A frame on its way to the player, with the session to which its times are reported (gone after a reconnect).
struct Arrival {
    net::Agreement agreement;
    net::FrameArrived arrived;
    std::weak_ptr<net::Session> session;
    std::optional<std::int64_t> pose_chosen_ns{}; ///< when we chose the pose that this frame is the first to show
    std::uint32_t session_number = 0; ///< of the run, from 1
    std::optional<timing::DeliveredFrame> record{}; ///< for the files of timings, if there are any
};

/// Tells the server what became of a frame. `rendered_ns` and `shown_ns` are 0 for a superseded one.
void report_times(const Arrival& arrival, bool was_superseded, std::int64_t rendered_ns, std::int64_t shown_ns);

/// Holds one frame: the newest complete one. Thread-safe.
class FrameMailbox {
public:
    /// Puts a frame in; returns the one it replaces, which was never taken.
    std::optional<Arrival> put(Arrival arrival);

    /// Nothing more will come.
    void close();

    /// Waits for a frame. Nothing after `close` or a stop request.
    std::optional<Arrival> take(const std::stop_token& stop);

private:
    struct State {
        std::optional<Arrival> newest;
        bool is_closed = false;
    };
    std::condition_variable changed_;
    Guarded<State> state_;
};

} // namespace fieldcast::client::play
