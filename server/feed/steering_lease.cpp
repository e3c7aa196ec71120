// SPDX-License-Identifier: Apache-2.0
#include "server/feed/steering_lease.h"

#include <algorithm>
#include <utility>

namespace fieldcast::feed {

SteeringLease::Id SteeringLease::join(Steerer steerer) {
    members_.emplace(++last_id_, Member{.steerer = std::move(steerer), .notices = {}});
    return last_id_;
}

void SteeringLease::leave(Id id, TimePoint now) {
    release(id, now);
    members_.erase(id);
}

void SteeringLease::request(Id id, SteeringUrgency urgency, TimePoint now) {
    look_at_clock(now);
    const SteeringRight right = members_.at(id).steerer.right;
    const bool is_taken = urgency == SteeringUrgency::kTake;
    if (right == SteeringRight::kNone || (is_taken && right != SteeringRight::kTake)) {
        return deny(id, SteeringDenial::Reason::kRoleTooLow);
    }
    if (holder_ && *holder_ != id && (is_taken || is_offered_)) {
        dismiss(is_taken ? SteeringLoss::Reason::kTaken : SteeringLoss::Reason::kHandedOver);
    }
    if (!holder_ || *holder_ == id) {
        return grant(id, now);
    }
    const bool is_in_queue = std::ranges::find(queue_, id) != queue_.end();
    if (urgency == SteeringUrgency::kWait && !is_in_queue) {
        queue_.push_back(id);
    }
    deny(id, SteeringDenial::Reason::kHeld);
}

bool SteeringLease::renew(Id id, TimePoint now) {
    look_at_clock(now);
    if (holder_ != id) {
        return false;
    }
    ends_ = now + length_;
    return true;
}

void SteeringLease::release(Id id, TimePoint now) {
    look_at_clock(now);
    remove_from_queue(id);
    if (holder_ == id) {
        dismiss(SteeringLoss::Reason::kReleased);
        grant_next(now);
    }
}

void SteeringLease::offer(Id id, TimePoint now) {
    look_at_clock(now);
    if (holder_ != id) {
        return;
    }
    is_offered_ = queue_.empty();
    if (!queue_.empty()) {
        dismiss(SteeringLoss::Reason::kHandedOver);
        grant_next(now);
    }
}

void SteeringLease::look_at_clock(TimePoint now) {
    if (holder_ && now >= ends_) {
        dismiss(SteeringLoss::Reason::kExpired);
        grant_next(now);
    }
}

std::optional<SteeringNotice> SteeringLease::next_notice(Id id) {
    auto& notices = members_.at(id).notices;
    if (notices.empty()) {
        return std::nullopt;
    }
    SteeringNotice notice = std::move(notices.front());
    notices.pop_front();
    return notice;
}

void SteeringLease::grant(Id id, TimePoint now) {
    remove_from_queue(id);
    lease_ += holder_ == id ? 0 : 1;
    holder_ = id;
    is_offered_ = false;
    ends_ = now + length_;
    members_.at(id).notices.emplace_back(SteeringGrant{.lease = lease_});
}

void SteeringLease::dismiss(SteeringLoss::Reason reason) {
    members_.at(*holder_).notices.emplace_back(SteeringLoss{.lease = lease_, .reason = reason});
    holder_.reset();
    is_offered_ = false;
}

void SteeringLease::grant_next(TimePoint now) {
    if (!queue_.empty()) {
        grant(queue_.front(), now);
    }
}

void SteeringLease::deny(Id id, SteeringDenial::Reason reason) {
    const auto place = std::ranges::find(queue_, id);
    const bool is_waiting = place != queue_.end();
    members_.at(id).notices.emplace_back(
        SteeringDenial{.reason = reason,
                       .holder = holder_ ? members_.at(*holder_).steerer.name : "",
                       .is_waiting = is_waiting,
                       .ahead = is_waiting ? static_cast<std::uint32_t>(place - queue_.begin()) : 0});
}

void SteeringLease::remove_from_queue(Id id) {
    std::erase(queue_, id);
}

} // namespace fieldcast::feed
