// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/client_session.h"
#include "client/play/attempts.h"
#include "client/play/change.h"
#include "client/play/frame_mailbox.h"
#include "client/play/pilot.h"
#include "client/play/server_options.h"
#include "client/play/statistics.h"
#include "core/timing/timing_recorder.h"

#include <chrono>
#include <optional>
#include <string>
#include <thread>

namespace fieldcast::client::play {

/// Why no more frames arrive.
struct Failure {
    std::string message;
    bool was_refused = false; ///< by the server; another request or token may succeed
};

/// Optional duties of a Receiver.
struct ReceiverExtras {
    std::optional<SteeringOptions> steering{}; ///< set: it also moves the camera
    std::vector<Change> changes{};             ///< requested on the running stream
    /// Receives superseded frames; if it is set, each Arrival has a record. Null: none. Must outlive the Receiver.
    timing::TimingRecorder* recorder = nullptr;
};

/// Maintains a session with a server: opens it, decodes frames into the mailbox, and reconnects after interruptions.
/// Has one thread, which may block on the network and on decoding.
class Receiver {
public:
    /// `scene_hash`: of the scene that we have, if any. The session ends if the server shows another scene.
    Receiver(const ServerOptions& server, const net::Request& request, std::optional<scene::SceneHash> scene_hash,
             ReceiverExtras extras = {});

    /// Waits for the newest complete frame. Nothing on a stop request, or after the last frame (see `failure`).
    std::optional<Arrival> take(const std::stop_token& stop) { return mailbox_.take(stop); }

    /// Half-closes, waits at most 2 s until the server has finished, and ends the thread.
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
    struct SessionState; ///< of the current session; for the thread

    void run(const std::stop_token& stop);
    SessionEnd run_session(const std::stop_token& stop, Attempts& attempts);
    void handle(net::Event event, SessionState& state);
    void agreed(net::Agreement agreement, SessionState& state);
    void refused(const net::Refused& refused, SessionState& state);
    void ask_for_change(SessionState& state);
    void arrived(net::FrameArrived frame, SessionState& state);
    void steered(const net::SteeringNews& news, SessionState& state);

    ServerOptions server_;
    net::Request request_; ///< the last one; repeated after a reconnect
    ChangeSchedule changes_;
    std::optional<scene::SceneHash> scene_hash_;
    std::optional<Pilot> pilot_; ///< for the thread
    timing::TimingRecorder* recorder_;
    WorkerPool pool_;
    FrameMailbox mailbox_;
    Guarded<StreamCounts> counts_;
    Guarded<std::optional<Failure>> failure_;
    std::jthread thread_;
};

} // namespace fieldcast::client::play
