// SPDX-License-Identifier: Apache-2.0
#include "server/feed/steering.h"

namespace fieldcast::feed {

SteeringSeat Steering::join(const std::shared_ptr<Steering>& steering, Steerer steerer) {
    return {steering, steering->state_.lock()->lease.join(std::move(steerer))};
}

std::optional<SteeredPose> Steering::sample() {
    auto state = state_.lock();
    std::optional<SteeredPose> pose = state->newest;
    if (state->newest) {
        state->newest->cut = false; // reported once
    }
    return pose;
}

SteeringSeat& SteeringSeat::operator=(SteeringSeat&& other) noexcept {
    if (this != &other) {
        leave();
        steering_ = std::move(other.steering_);
        id_ = other.id_;
    }
    return *this;
}

void SteeringSeat::request(SteeringUrgency urgency, TimePoint now) {
    steering_->state_.lock()->lease.request(id_, urgency, now);
}

void SteeringSeat::release(TimePoint now) {
    steering_->state_.lock()->lease.release(id_, now);
}

void SteeringSeat::offer(TimePoint now) {
    steering_->state_.lock()->lease.offer(id_, now);
}

bool SteeringSeat::renew(TimePoint now) {
    return steering_->state_.lock()->lease.renew(id_, now);
}

bool SteeringSeat::steer(SteeredPose pose, TimePoint now) {
    auto state = steering_->state_.lock();
    if (!state->lease.renew(id_, now)) {
        return false;
    }
    pose.lease = state->lease.lease();
    const std::optional<SteeredPose>& newest = state->newest;
    if (newest && newest->lease == pose.lease && newest->sequence >= pose.sequence) {
        return true;
    }
    pose.cut = pose.cut || (newest && newest->cut); // a jump that no frame has shown yet
    state->newest = pose;
    return true;
}

std::optional<SteeringNotice> SteeringSeat::next_notice(TimePoint now) {
    auto state = steering_->state_.lock();
    state->lease.look_at_clock(now);
    return state->lease.next_notice(id_);
}

void SteeringSeat::leave() {
    if (steering_ != nullptr) {
        steering_->state_.lock()->lease.leave(id_, std::chrono::steady_clock::now());
        steering_.reset();
    }
}

} // namespace fieldcast::feed
