// SPDX-License-Identifier: Apache-2.0
#include "server/session/steering_desk.h"

#include "core/wire/convert.h"

#include <glm/glm.hpp>

namespace fieldcast::session {

namespace {

constexpr const char* kNoSteerableCamera = "first configure a channel whose camera clients can steer";
constexpr const char* kNotHolder = "send RequestSteering first and wait for SteeringGranted";

using Denial = feed::SteeringDenial;
using Loss = feed::SteeringLoss;

v1::SteeringDenialReason to_proto(Denial::Reason reason) {
    switch (reason) {
    case Denial::Reason::kRoleTooLow:
        return v1::STEERING_DENIAL_REASON_ROLE_TOO_LOW;
    case Denial::Reason::kHeld:
        break;
    }
    return v1::STEERING_DENIAL_REASON_HELD;
}

v1::SteeringReleaseReason to_proto(Loss::Reason reason) {
    switch (reason) {
    case Loss::Reason::kReleased:
        return v1::STEERING_RELEASE_REASON_RELEASED;
    case Loss::Reason::kHandedOver:
        return v1::STEERING_RELEASE_REASON_HANDED_OVER;
    case Loss::Reason::kTaken:
        return v1::STEERING_RELEASE_REASON_TAKEN;
    case Loss::Reason::kExpired:
        break;
    }
    return v1::STEERING_RELEASE_REASON_EXPIRED;
}

v1::ServerMessage denied(const Denial& denial) {
    v1::ServerMessage message;
    v1::SteeringDenied& denied = *message.mutable_steering_denied();
    denied.set_reason(to_proto(denial.reason));
    denied.set_holder(denial.holder);
    denied.set_waits(denial.is_waiting);
    denied.set_ahead(denial.ahead);
    denied.set_message(denial.reason == Denial::Reason::kRoleTooLow
                           ? "steering needs the role steer; taking the camera from another client needs the role admin"
                           : "the camera is steered by " + denial.holder);
    return message;
}

v1::ServerMessage released(std::uint64_t lease, v1::SteeringReleaseReason reason) {
    v1::ServerMessage message;
    message.mutable_steering_released()->set_lease(lease);
    message.mutable_steering_released()->set_reason(reason);
    return message;
}

/// `pose` made exactly rigid, since clients' matrices are rounded; the viewing direction stays.
glm::mat4 rigid(const glm::mat4& pose) {
    const glm::vec3 z = glm::normalize(glm::vec3(pose[2]));
    const glm::vec3 x = glm::normalize(glm::vec3(pose[0]) - z * glm::dot(z, glm::vec3(pose[0])));
    return {glm::vec4(x, 0.0F), glm::vec4(glm::cross(z, x), 0.0F), glm::vec4(z, 0.0F),
            glm::vec4(glm::vec3(pose[3]), 1.0F)};
}

} // namespace

SteeringDesk::SteeringDesk(feed::Steerer steerer, double max_poses_per_second, log::Quota& lines)
    : steerer_(std::move(steerer)), poses_({.per_second = max_poses_per_second, .burst = max_poses_per_second}),
      lines_(lines) {}

void SteeringDesk::move_to(const std::shared_ptr<feed::Steering>& steering, TimePoint now) {
    if (seat_.steering() == steering) {
        return;
    }
    if (is_at_camera()) {
        collect(now);
        if (lease_ != 0) {
            answers_.push_back(released(lease_, v1::STEERING_RELEASE_REASON_RECONFIGURED));
        }
        leave();
    }
    if (steering != nullptr) {
        seat_ = feed::Steering::join(steering, steerer_);
    }
}

void SteeringDesk::leave() {
    lease_ = 0;
    seat_.leave();
}

void SteeringDesk::handle(const v1::RequestSteering& message, TimePoint now) {
    if (!is_at_camera()) {
        return deny(v1::STEERING_DENIAL_REASON_NOT_STEERABLE, kNoSteerableCamera, 0);
    }
    seat_.request(message.takes()   ? feed::SteeringUrgency::kTake
                  : message.waits() ? feed::SteeringUrgency::kWait
                                    : feed::SteeringUrgency::kNow,
                  now);
    collect(now);
}

void SteeringDesk::handle(const v1::SteerCamera& message, TimePoint now) {
    if (!is_at_camera()) {
        return deny(v1::STEERING_DENIAL_REASON_NOT_STEERABLE, kNoSteerableCamera, message.sequence());
    }
    if (message.world_from_camera().empty()) {
        if (!seat_.renew(now)) {
            deny(v1::STEERING_DENIAL_REASON_NOT_HOLDER, kNotHolder, message.sequence());
        }
        return;
    }
    const auto pose = wire::pose_from_proto(message.world_from_camera());
    if (!pose) {
        return deny(v1::STEERING_DENIAL_REASON_INVALID_POSE, pose.error().message, message.sequence());
    }
    steer(message, *pose, now);
}

void SteeringDesk::steer(const v1::SteerCamera& message, const glm::mat4& pose, TimePoint now) {
    if (!poses_.take(now)) {
        return deny(v1::STEERING_DENIAL_REASON_TOO_FAST, "the client sends more poses per second than it may",
                    message.sequence());
    }
    const feed::SteeredPose wanted{.sequence = message.sequence(),
                                   .client_time_ns = message.client_time_ns(),
                                   .world_from_camera = rigid(pose),
                                   .cut = message.cut()};
    if (!seat_.steer(wanted, now)) {
        deny(v1::STEERING_DENIAL_REASON_NOT_HOLDER, kNotHolder, message.sequence());
    }
}

void SteeringDesk::release(TimePoint now) {
    if (is_at_camera()) {
        seat_.release(now);
        collect(now);
    }
}

void SteeringDesk::offer(TimePoint now) {
    if (is_at_camera()) {
        seat_.offer(now);
        collect(now);
    }
}

std::optional<v1::ServerMessage> SteeringDesk::next(TimePoint now) {
    if (is_at_camera()) {
        collect(now);
    }
    if (answers_.empty()) {
        return std::nullopt;
    }
    v1::ServerMessage message = std::move(answers_.front());
    answers_.pop_front();
    return message;
}

void SteeringDesk::deny(v1::SteeringDenialReason reason, const std::string& message, std::uint64_t sequence) {
    v1::SteeringDenied& denied = *answers_.emplace_back().mutable_steering_denied();
    denied.set_reason(reason);
    denied.set_message(message);
    denied.set_sequence(sequence);
}

void SteeringDesk::collect(TimePoint now) {
    while (const auto notice = seat_.next_notice(now)) {
        if (const auto* const denial = std::get_if<Denial>(&*notice)) {
            answers_.push_back(denied(*denial));
        } else if (const auto* const loss = std::get_if<Loss>(&*notice)) {
            lease_ = 0;
            answers_.push_back(released(loss->lease, to_proto(loss->reason)));
            lines_.write(log::Level::kInfo, "steering ended", {{"by", steerer_.name}, {"lease", loss->lease}}, now);
        } else {
            lease_ = std::get<feed::SteeringGrant>(*notice).lease;
            v1::SteeringGranted& granted = *answers_.emplace_back().mutable_steering_granted();
            granted.set_lease(lease_);
            granted.set_expires_after_ms(static_cast<std::uint32_t>(seat_.steering()->lease_length().count()));
            lines_.write(log::Level::kInfo, "steering begins", {{"by", steerer_.name}, {"lease", lease_}}, now);
        }
    }
}

} // namespace fieldcast::session
