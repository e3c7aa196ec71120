// SPDX-License-Identifier: Apache-2.0
#include "server/channel/fair_turns.h"

#include <algorithm>

namespace fieldcast::channel {

namespace {

/// The device waits for a previous holder at most 1/8 of the cost of the next turn.
constexpr int kPatienceDivisor = 8;

} // namespace

FairTurns::Id FairTurns::join() {
    members_.emplace(++last_id_, Member{.finish = virtual_time_});
    return last_id_;
}

void FairTurns::leave(Id id) {
    members_.erase(id);
    if (running_ == id) {
        running_.reset();
    }
}

void FairTurns::want(Id id) {
    Member& member = members_.at(id);
    member.start = std::max(member.finish, virtual_time_);
    member.is_waiting = true;
}

void FairTurns::give_up(Id id) {
    members_.at(id).is_waiting = false;
}

bool FairTurns::is_before(Id id, const Member& member) const {
    return std::ranges::any_of(members_, [&](const auto& entry) {
        const auto& [other_id, other] = entry;
        return other.is_waiting && other_id != id &&
               (other.start < member.start || (other.start == member.start && other_id < id));
    });
}

FairTurns::TimePoint FairTurns::patience_ends(const Member& asking) const {
    TimePoint ends = TimePoint::min();
    for (const auto& [id, other] : members_) {
        const bool is_behind =
            other.has_turned && !other.is_waiting && std::max(other.finish, virtual_time_) < asking.start;
        if (is_behind) {
            ends = std::max(ends, other.ended + asking.cost / kPatienceDivisor);
        }
    }
    return ends;
}

bool FairTurns::may_begin(Id id, TimePoint now) const {
    const Member& member = members_.at(id);
    return !running_ && !is_before(id, member) && now >= patience_ends(member);
}

std::optional<FairTurns::TimePoint> FairTurns::ask_again(Id id, TimePoint now) const {
    const Member& member = members_.at(id);
    const TimePoint ends = patience_ends(member);
    const bool is_patient = !running_ && !is_before(id, member) && now < ends;
    return is_patient ? std::optional(ends) : std::nullopt;
}

void FairTurns::begin(Id id, TimePoint now) {
    Member& member = members_.at(id);
    member.is_waiting = false;
    virtual_time_ = member.start;
    running_ = id;
    begun_ = now;
}

void FairTurns::end(Id id, TimePoint now) {
    Member& member = members_.at(id);
    member.cost = now - begun_;
    member.finish = member.start + member.cost;
    member.ended = now;
    member.has_turned = true;
    running_.reset();
}

} // namespace fieldcast::channel
