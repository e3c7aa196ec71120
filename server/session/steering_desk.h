// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/log_quota.h"
#include "core/base/rate_limit.h"
#include "server/feed/steering.h"

#include "fieldcast/v1/light_field.pb.h"

#include <deque>
#include <memory>
#include <optional>

namespace fieldcast::session {

/// What one session has to do with the camera of its channel: takes its messages about it, has the answers and what
/// happens to its lease. Not thread-safe.
class SteeringDesk {
public:
    using TimePoint = feed::Steering::TimePoint;

    /// `lines` must outlive the desk.
    SteeringDesk(feed::Steerer steerer, double max_poses_per_second, log::Quota& lines);

    /// The session is at this camera now; null: at none that can be steered. The same one again changes nothing.
    void move_to(const std::shared_ptr<feed::Steering>& steering, TimePoint now);
    void leave(); ///< silently

    void handle(const v1::RequestSteering& message, TimePoint now);
    void handle(const v1::SteerCamera& message, TimePoint now);
    void release(TimePoint now);
    void offer(TimePoint now);

    /// The next message to send.
    std::optional<v1::ServerMessage> next(TimePoint now);
    bool may_steer() const { return steerer_.right != feed::SteeringRight::kNone; }
    std::size_t waiting() const {
        return answers_.size();
    } ///< messages to send, those of other threads' doing excepted

private:
    void steer(const v1::SteerCamera& message, const glm::mat4& pose, TimePoint now);
    void deny(v1::SteeringDenialReason reason, const std::string& message, std::uint64_t sequence);
    void collect(TimePoint now); ///< what happened to the lease
    bool is_at_camera() const { return seat_.steering() != nullptr; }

    const feed::Steerer steerer_;
    feed::SteeringSeat seat_;
    std::uint64_t lease_ = 0; ///< that it holds, as far as it was told; 0: none
    RateLimit poses_;
    log::Quota& lines_;
    std::deque<v1::ServerMessage> answers_;
};

} // namespace fieldcast::session
