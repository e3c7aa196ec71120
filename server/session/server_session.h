// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/log_quota.h"
#include "core/base/rate_limit.h"
#include "server/session/close_reason.h"
#include "server/session/frame_sender.h"
#include "server/session/steering_desk.h"

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fieldcast::session {

/// The protocol of one client: passes its messages on to its agreement, its frames and its steering, queues the
/// answers, and watches the deadlines. Knows no transport: the owner hands in messages and frames, and calls next()
/// whenever the previous message has been written. Not thread-safe. Memory is bounded: kMaxQueuedAnswers answers and
/// two frames.
class ServerSession {
public:
    /// `channels` must not be empty. `on_frame` must lead to ServerSession::on_frame; it may come from any thread.
    ServerSession(std::vector<std::shared_ptr<feed::Feed>> channels, const Limits& limits, feed::FrameCallback on_frame,
                  TimePoint now, const PeerBudgets& budgets = {}, feed::Steerer steerer = {});

    /// A message of `size` bytes has arrived. Its bytes count towards the message rate before it is parsed.
    void on_bytes(std::size_t size, TimePoint now);
    void on_message(const v1::ClientMessage& message, TimePoint now);
    void on_frame(const feed::FramePtr& frame, TimePoint now) { sender_.on_frame(frame, now); }

    /// False: the answer queue is full; read the client's next message only after it has drained.
    bool accepts_input() const { return answers_.size() + steering_.waiting() < kMaxQueuedAnswers; }

    /// The next message to write, if there is one now.
    std::optional<wire::WireChunk> next(TimePoint now);

    /// From `at` on: sends GoingAway, then begins no further frames. The first call counts. kRevoked cuts the stream
    /// after limits.revoked_deadline, even if the client does not read GoingAway.
    void go_away(const std::string& reason, TimePoint at, CloseReason why = CloseReason::kDrained);

    /// Checks deadlines and adapts the configuration to the connection; call it several times per heartbeat interval.
    void on_tick(TimePoint now);

    /// The client was sent GoingAway and has not closed in time: cut the stream.
    bool is_overdue(TimePoint now) const { return cut_at_ && now >= *cut_at_; }

    /// Ladder rungs below what the client asked for, because of its connection; 0: it gets what it asked for.
    std::size_t adapted_level() const { return sender_.in_flight().adapter().level(); }

    /// For log lines that the client causes.
    log::Quota& lines() { return lines_; }

    /// Timings of its frames; empty unless enabled.
    FrameTimings& timings() { return sender_.in_flight().timings(); }

    /// Ends the subscription and the steering: no further frames are rendered for this client.
    void end();

    const std::optional<Configuration>& configuration() const { return agreement_.configuration(); } ///< in force
    std::uint32_t epoch() const { return agreement_.epoch(); }
    const SessionCounts& counts() const { return counts_; }
    const Credits& credits() const { return sender_.in_flight().credits(); }
    std::optional<CloseReason> close_reason() const { return close_reason_; } ///< set by go_away

    /// The client exceeds its message rate; end the stream.
    bool is_flooded() const { return is_flooded_; }

private:
    struct Departure {
        std::string reason;
        TimePoint at;
    };

    void handle(const v1::Configure& wanted, TimePoint now);
    void refuse(const Refusal& refusal, std::uint32_t request_id);
    v1::Configured& begin_epoch(); ///< of the configuration just granted; returns the answer, which is queued
    void adapt(TimePoint now);
    std::optional<wire::WireChunk> next_control(TimePoint now);
    v1::ServerMessage depart(TimePoint now);
    v1::ServerMessage heartbeat() const;
    bool is_leaving() const { return departure_ || cut_at_; }

    const Limits limits_;
    RateLimit messages_;
    bool is_flooded_ = false;
    std::uint32_t request_id_ = 0; ///< of the Configure that was granted last
    std::deque<v1::ServerMessage> answers_;
    std::optional<Departure> departure_; ///< GoingAway is to be sent
    std::optional<TimePoint> cut_at_;    ///< set when GoingAway was sent, or when the token was revoked
    std::optional<CloseReason> close_reason_;
    TimePoint next_heartbeat_;
    TimePoint configure_by_;
    SessionCounts counts_;
    log::Quota lines_;
    SteeringDesk steering_;
    FrameSender sender_;
    Agreement agreement_; ///< last: its subscription ends before what `on_frame` leads to
};

} // namespace fieldcast::session
