// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/session.h"
#include "client/play/attempts.h"
#include "client/play/change.h"
#include "client/play/frame_mailbox.h"
#include "client/play/pilot.h"
#include "client/play/statistics.h"
#include "core/timing/recorder.h"

#include <chrono>
#include <optional>
#include <string>
#include <thread>

namespace fieldcast::client::play {

/// How to reach a server, and what to do when that fails.
struct ServerOptions {
    std::string address = "127.0.0.1:50151"; ///< "host:port"
    net::Access access{};
    bool reconnects = true;
    std::chrono::milliseconds patience{30'000}; ///< gives up when nothing has worked for so long
};

/// Why no more frames come.
struct Failure {
    std::string message;
    bool was_refused = false; ///< the server will not do what was asked, or for whom: another request or token may work
};

/// What a receiver may do besides.
struct ReceiverExtras {
    std::optional<SteeringOptions> steering{}; ///< moves the camera, too
    std::vector<Change> changes{};             ///< are asked for on the running stream
    /// Gets frames that are superseded, and arrivals a record; null: none. Must outlive this.
    timing::Recorder* recorder = nullptr;
};

/// Keeps a session with a server: opens it, decodes frames into the mailbox, comes back after interruptions. Has one
/// thread, which may block on the network and on decoding.
class Receiver {
public:
    /// `scene_hash`: of the scene at hand (mode kScene); a server that shows another one is left.
    Receiver(const ServerOptions& server, const net::Request& request, std::optional<scene::SceneHash> scene_hash,
             ReceiverExtras extras = {});

    /// The newest complete frame. Nothing on a stop request, or when no more will come (see `failure`).
    std::optional<Arrival> take(const std::stop_token& stop) { return mailbox_.take(stop); }

    /// Half-closes, waits for the server to finish (2 s at most), ends the thread.
    void finish();

    StreamCounts counts() { return *counts_.lock(); }
    std::optional<Failure> failure() { return *failure_.lock(); }

private:
    struct SessionEnd {
        std::string message;
        bool is_transient = true;
        bool was_refused = false;
        net::Obstacle obstacle = net::Obstacle::kRefused;
    };
    struct SessionState; ///< of the session in progress, for the thread

    void run(const std::stop_token& stop);
    SessionEnd run_session(const std::stop_token& stop, Attempts& attempts);
    void handle(net::Event event, SessionState& state);
    void agreed(net::Agreement agreement, SessionState& state);
    void refused(const net::Refused& refused, SessionState& state);
    void ask_for_change(SessionState& state);
    void arrived(net::FrameArrived frame, SessionState& state);
    void steered(const net::SteeringNews& news, SessionState& state);

    ServerOptions server_;
    net::Request request_; ///< asked for last, and again after a reconnect
    ChangeSchedule changes_;
    std::optional<scene::SceneHash> scene_hash_;
    std::optional<Pilot> pilot_; ///< for the thread
    timing::Recorder* recorder_;
    WorkerPool pool_;
    FrameMailbox mailbox_;
    Guarded<StreamCounts> counts_;
    Guarded<std::optional<Failure>> failure_;
    std::jthread thread_;
};

} // namespace fieldcast::client::play
