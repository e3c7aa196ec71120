// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/client_session.h"
#include "client/play/camera_path.h"

#include <chrono>
#include <optional>
#include <string>

namespace fieldcast::client::play {

/// How to steer the camera of the channel.
struct SteeringOptions {
    PoseSource poses;
    bool waits = true; ///< in the queue while another client steers; otherwise that is a failure
};

/// Steers for a session: requests the camera, sends poses when they are due and keep-alives between them, and finds the
/// frames that show our poses. For one thread.
class Pilot {
public:
    using Clock = std::chrono::steady_clock;

    explicit Pilot(SteeringOptions options) : options_(std::move(options)) {}

    /// Call it when a session begins. Requests the camera.
    void begin(net::ClientSession& session);

    /// Sends the pose or keep-alive that is due at `now`.
    void steer(net::ClientSession& session, Clock::time_point now);
    Clock::time_point next_call() const { return is_steering() ? next_pose_ : Clock::time_point::max(); }

    /// Handles the server's answer. Returns why the run must end, or nothing.
    std::optional<std::string> handle(net::ClientSession& session, const net::SteeringNews& news,
                                      Clock::time_point now);

    /// When we chose the pose that this frame shows, if it is the first frame with that pose.
    std::optional<std::int64_t> chosen_ns(const FrameHeader& header);

private:
    bool is_steering() const { return lease_ != 0; }

    SteeringOptions options_;
    std::uint64_t lease_ = 0; ///< 0: we do not steer
    std::uint64_t sequence_ = 0;
    std::uint64_t shown_sequence_ = 0;
    std::optional<glm::mat4> start_; ///< pose of the camera in the first frame
    std::chrono::milliseconds keep_alive_period_{1000};
    Clock::time_point begun_{};
    Clock::time_point next_pose_{};
    Clock::time_point last_sent_{};
};

} // namespace fieldcast::client::play
