// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/session.h"
#include "client/play/camera_path.h"

#include <chrono>
#include <optional>
#include <string>

namespace fieldcast::client::play {

/// How to steer the camera of the channel.
struct SteeringOptions {
    PoseSource poses;
    bool waits = true; ///< until it is our turn; else it is a failure if somebody else steers
};

/// Steers for a session: asks for the camera, sends poses as they are due, lets the server know that we are there, and
/// finds our poses again in frames. For one thread.
class Pilot {
public:
    using Clock = std::chrono::steady_clock;

    explicit Pilot(SteeringOptions options) : options_(std::move(options)) {}

    /// A session begins: asks for the camera.
    void begin(net::Session& session);

    /// Sends what is due at `now`.
    void look(net::Session& session, Clock::time_point now);
    Clock::time_point next_call() const { return is_steering() ? next_pose_ : Clock::time_point::max(); }

    /// Empty, or why there is no use in going on.
    std::optional<std::string> handle(net::Session& session, const net::SteeringNews& news, Clock::time_point now);

    /// When we chose the pose that this frame shows, if it is the first one that does.
    std::optional<std::int64_t> chosen_ns(const FrameHeader& header);

private:
    bool is_steering() const { return lease_ != 0; }

    SteeringOptions options_;
    std::uint64_t lease_ = 0; ///< 0: we do not steer
    std::uint64_t sequence_ = 0;
    std::uint64_t shown_sequence_ = 0;
    std::optional<glm::mat4> start_; ///< where the camera was when we came
    std::chrono::milliseconds sign_of_life_period_{1000};
    Clock::time_point begun_{};
    Clock::time_point next_pose_{};
    Clock::time_point last_sent_{};
};

} // namespace fieldcast::client::play
