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

/// Steering for one session: handles the client's steering messages, and queues the answers and the news about its
/// lease. Not thread-safe.
class SteeringDesk {
public:
    using TimePoint = feed::Steering::TimePoint;

    /// `lines` must outlive the desk.
    SteeringDesk(feed::Steerer steerer, double max_poses_per_second, log::Quota& lines);

    /// The session now watches this camera; null: one that cannot be steered. The same camera again changes nothing.
    void move_to(const std::shared_ptr<feed::Steering>& steering, TimePoint now);
    void leave(); ///< gives the lease up without a message to the client

    void handle(const v1::RequestSteering& message, TimePoint now);
    void handle(const v1::SteerCamera& message, TimePoint now);
    void release(TimePoint now); ///< handles ReleaseSteering
    void offer(TimePoint now);   ///< handles OfferSteering

    /// The next message to send.
    std::optional<v1::ServerMessage> next(TimePoint now);
    bool may_steer() const { return steerer_.right != feed::SteeringRight::kNone; }

    /// Number of messages to send, without lease news that other threads have just caused.
    std::size_t waiting() const { return answers_.size(); }

private:
    void steer(const v1::SteerCamera& message, const glm::mat4& pose, TimePoint now);
    void deny(v1::SteeringDenialReason reason, const std::string& message, std::uint64_t sequence);
    void collect(TimePoint now); ///< turns news about the lease into answers
    bool is_at_camera() const { return seat_.steering() != nullptr; }

    const feed::Steerer steerer_;
    feed::SteeringSeat seat_;
    std::uint64_t lease_ = 0; ///< the lease that the client was told it holds; 0: none
    RateLimit poses_;
    log::Quota& lines_;
    std::deque<v1::ServerMessage> answers_;
};

} // namespace fieldcast::session
