// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/client_session.h"
#include "core/base/guarded.h"
#include "core/timing/frame_timing.h"

#include <condition_variable>
#include <memory>
#include <optional>
#include <stop_token>

namespace fieldcast::client::play {

/// A frame for the player, and the session to which its times are reported.
struct Arrival {
    net::Agreement agreement;
    net::FrameArrived arrived;
    std::weak_ptr<net::ClientSession> session;    ///< null after a reconnect
    std::optional<std::int64_t> pose_chosen_ns{}; ///< when we chose the pose that this frame is the first to show
    std::uint32_t session_number = 0; ///< within the run, from 1
    std::optional<timing::DeliveredFrame> record{}; ///< set if timing files are written
};

/// Reports the fate of a frame to the server. `rendered_ns` and `shown_ns` are 0 for a superseded one.
void report_times(const Arrival& arrival, bool was_superseded, std::int64_t rendered_ns, std::int64_t shown_ns);

/// Holds the newest complete frame. Thread-safe.
class FrameMailbox {
public:
    /// Puts a frame in. Returns the frame that it replaces, which was never taken.
    std::optional<Arrival> put(Arrival arrival);

    /// Call it after the last frame.
    void close();

    /// Waits for a frame and takes it. Nothing once the closed mailbox is empty, or on a stop request.
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
