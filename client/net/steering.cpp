// SPDX-License-Identifier: Apache-2.0
#include "client/net/steering.h"

#include "core/base/printable.h"

#include <algorithm>

namespace fieldcast::client::net {
namespace {

using Kind = SteeringNews::Kind;

constexpr std::uint32_t kShortestLease_ms = 100; // with less, the client would have to send all the time

std::string reason_text(v1::SteeringReleaseReason reason) {
    switch (reason) {
    case v1::STEERING_RELEASE_REASON_HANDED_OVER:
        return "handed over";
    case v1::STEERING_RELEASE_REASON_TAKEN:
        return "an operator has taken the camera";
    case v1::STEERING_RELEASE_REASON_EXPIRED:
        return "inactive for too long";
    default: // also values that are newer than this program
        return "released";
    }
}

} // namespace

v1::ClientMessage to_request(bool waits) {
    v1::ClientMessage message;
    message.mutable_request_steering()->set_waits(waits);
    return message;
}

v1::ClientMessage to_pose(const WantedPose& pose, std::uint64_t sequence, std::int64_t client_time_ns) {
    v1::ClientMessage message;
    v1::SteerCamera& steer = *message.mutable_steer_camera();
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) {
            steer.add_world_from_camera(pose.world_from_camera[column][row]);
        }
    }
    steer.set_sequence(sequence);
    steer.set_client_time_ns(client_time_ns);
    steer.set_cut(pose.cut);
    return message;
}

v1::ClientMessage keep_alive() {
    v1::ClientMessage message;
    message.mutable_steer_camera();
    return message;
}

SteeringNews to_news(const v1::SteeringGranted& message) {
    return {.kind = Kind::kGranted,
            .lease = message.lease(),
            .expires_after = std::chrono::milliseconds(std::max(message.expires_after_ms(), kShortestLease_ms)),
            .message = ""};
}

SteeringNews to_news(const v1::SteeringDenied& message) {
    const Kind kind = message.sequence() != 0 || message.reason() == v1::STEERING_DENIAL_REASON_NOT_HOLDER
                          ? Kind::kPassedOver
                      : message.waits() ? Kind::kWaiting
                                        : Kind::kRefused;
    return {.kind = kind, .lease = 0, .expires_after = {}, .message = printable(message.message())};
}

SteeringNews to_news(const v1::SteeringReleased& message) {
    const bool has_expired = message.reason() == v1::STEERING_RELEASE_REASON_EXPIRED;
    return {.kind = has_expired ? Kind::kExpired : Kind::kReleased,
            .lease = 0,
            .expires_after = {},
            .message = reason_text(message.reason())};
}

} // namespace fieldcast::client::net
