// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fieldcast/v1/light_field.pb.h"

#include <chrono>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>

namespace fieldcast::client::net {

/// A pose to which we want to move the channel's camera.
struct WantedPose {
    glm::mat4 world_from_camera{1.0F}; ///< rigid
    bool cut = false;                  ///< a jump instead of a movement
};

/// The server's answers to, and changes of, our steering.
struct SteeringNews {
    enum class Kind : std::uint8_t {
        kGranted,    ///< we steer
        kWaiting,    ///< another client steers; we are in the queue
        kRefused,    ///< another client steers and we are not in the queue, or we may not steer at all
        kPassedOver, ///< the server ignored one pose
        kExpired,    ///< we lost the camera because we were inactive for too long
        kReleased,   ///< we no longer steer, at our own request or because another client took the camera
    };
    Kind kind = Kind::kReleased;
    std::uint64_t lease = 0;                   ///< kGranted
    std::chrono::milliseconds expires_after{}; ///< kGranted: inactivity after which we lose the camera
    std::string message;                       ///< for people; printable
};

/// Asks for the camera. `waits`: in the queue while another client steers.
v1::ClientMessage to_request(bool waits);

/// Moves the camera. `sequence` is above 0 and grows within a lease. Frames return `client_time_ns`, the time at which
/// we chose the pose.
v1::ClientMessage to_pose(const WantedPose& pose, std::uint64_t sequence, std::int64_t client_time_ns);

/// Keeps the camera without moving it.
v1::ClientMessage keep_alive();

SteeringNews to_news(const v1::SteeringGranted& message);
SteeringNews to_news(const v1::SteeringDenied& message);
SteeringNews to_news(const v1::SteeringReleased& message);

} // namespace fieldcast::client::net
