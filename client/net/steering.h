// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fieldcast/v1/light_field.pb.h"

#include <chrono>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>

namespace fieldcast::client::net {

/// Where we want the camera of the channel.
struct WantedPose {
    glm::mat4 world_from_camera{1.0F}; ///< rigid
    bool cut = false;                  ///< a jump, not a movement
};

/// What the server says about our steering.
struct SteeringNews {
    enum class Kind : std::uint8_t {
        kGranted,
        kWaiting,  ///< somebody else steers; we are in the queue
        kRefused,  ///< and we are not, or we may not steer at all
        kPassedOver, ///< one pose was not taken
        kExpired,  ///< we were silent for too long, and do not steer any more
        kReleased, ///< we do not steer any more, as we or others wanted
    };
    Kind kind = Kind::kReleased;
    std::uint64_t lease = 0;                   ///< kGranted
    std::chrono::milliseconds expires_after{}; ///< kGranted: without a sign of life
    std::string message;                       ///< for people
};

v1::ClientMessage to_request(bool waits);
v1::ClientMessage to_pose(const WantedPose& pose, std::uint64_t sequence, std::int64_t client_time_ns);
v1::ClientMessage sign_of_life();

SteeringNews to_news(const v1::SteeringGranted& message);
SteeringNews to_news(const v1::SteeringDenied& message);
SteeringNews to_news(const v1::SteeringReleased& message);

} // namespace fieldcast::client::net
