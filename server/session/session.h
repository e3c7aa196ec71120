// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/log_quota.h"
#include "core/base/rate_limit.h"
#include "server/session/adapter.h"
#include "server/session/budget.h"
#include "server/session/close_reason.h"
#include "server/session/credits.h"
#include "server/session/frame_timings.h"
#include "server/session/mailbox.h"
#include "server/session/negotiate.h"
#include "server/session/session_counts.h"
#include "server/session/start_rhythm.h"
#include "server/session/steering_desk.h"

#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace fieldcast::session {

/// One client: its configuration, what it is owed, and the next message to write. Knows no transport: whoever owns it
/// hands in messages and frames, and calls next() whenever the previous message has been written.
/// Not thread-safe. Memory is bounded: one frame in the mailbox, one being sent, kMaxQueuedAnswers answers.
class Session {
public:
    /// `channels` must not be empty. `on_frame` must lead to Session::on_frame; it may come from any thread.
    Session(std::vector<std::shared_ptr<feed::Feed>> channels, const Limits& limits, feed::FrameCallback on_frame,
            TimePoint now, const PeerBudgets& budgets = {}, feed::Steerer steerer = {});

    /// The bytes of a message have come. They count before anybody reads them.
    void on_bytes(std::size_t size, TimePoint now);
    void on_message(const v1::ClientMessage& message, TimePoint now);
    void on_frame(const feed::FramePtr& frame, TimePoint now);

    /// False: answers are waiting; read the client's next message only when they have gone.
    bool accepts_input() const { return answers_.size() + steering_.waiting() < kMaxQueuedAnswers; }

    /// The next message to write, if there is one now.
    std::optional<wire::WireChunk> next(TimePoint now);

    /// From `at` on: says GoingAway, then sends no further frames. The first call counts. Whose token has gone is cut
    /// after limits.revoked_deadline, even if it does not read what it is told.
    void go_away(const std::string& reason, TimePoint at, CloseReason why = CloseReason::kDrained);

    /// Watches deadlines, and whether the configuration fits the connection; call it several times per heartbeat
    /// interval.
    void on_tick(TimePoint now);

    /// The client was told to go and has not gone in time: cut the stream.
    bool is_overdue(TimePoint now) const { return cut_at_ && now >= *cut_at_; }

    /// Steps that the server has taken away from what was asked for, because of the connection.
    std::size_t adapted_level() const { return adapter_.level(); }

    /// For what the client causes to be logged.
    log::Quota& lines() { return lines_; }

    /// When its frames were where; nothing unless enabled.
    FrameTimings& timings() { return timings_; }

    /// Gives up its place in the channel: no further frames are rendered for it.
    void end();

    const std::optional<Configuration>& configuration() const { return configuration_; } ///< in force
    std::uint32_t epoch() const { return epoch_; }
    const SessionCounts& counts() const { return counts_; }
    const Credits& credits() const { return credits_; }
    std::optional<CloseReason> close_reason() const { return close_reason_; } ///< set by go_away

    /// The client sends more than it may; end the stream.
    bool is_flooded() const { return is_flooded_; }

private:
    struct Departure {
        std::string reason;
        TimePoint at;
    };
    /// A frame between its header chunk and its trailer.
    struct Sending {
        wire::WireFrame frame;
        std::size_t next_chunk = 0;
        wire::ServerTimes times;
        std::map<wire::PlaneChoice, std::uint64_t> plane_bytes;
    };

    void handle(const v1::Configure& wanted, TimePoint now);
    void handle(const v1::FrameAck& ack, TimePoint now);
    void refuse(const Refusal& refusal, std::uint32_t request_id);
    v1::Configured& begin_epoch(Configuration chosen); ///< the answer, which is queued
    void adapt(TimePoint now);
    std::optional<Refusal> admit(Configuration& wanted); ///< on success its feed is where the frames come from
    std::optional<Refusal> subscribe(Configuration& wanted);
    tl::expected<feed::OwnFeed, Refusal> open_own_feed(const Configuration& wanted);
    void count_camera(); ///< among those of its peer
    std::optional<Refusal> change_own_feed(Configuration& wanted);
    void close_feeds(); ///< no frames from now on
    void drop_old_configuration();
    DropReason waiting_reason() const; ///< why the frame in the mailbox is not being sent
    void miss_frame(const feed::EncodedFrame& frame, DropReason reason);
    void tell_room(TimePoint now); ///< to the feed: whether a frame waits
    void begin_frame(TimePoint now); ///< if there is one and it may be sent

    std::optional<wire::WireChunk> next_control(TimePoint now);
    v1::ServerMessage depart(TimePoint now);
    v1::ServerMessage heartbeat() const;
    void start_frame(TimePoint now);
    wire::WireFrame chunks_of(const feed::EncodedFrame& frame) const;
    std::map<wire::PlaneChoice, std::uint64_t> plane_bytes_of(const feed::EncodedFrame& frame,
                                                              const wire::WireFrame& chunks) const;
    bool has_key_frame_of(const feed::EncodedFrame& frame) const; ///< the client has, or this is it
    void set_key_frame(std::uint64_t frame_id);                   ///< that the client has; 0: none
    wire::WireChunk next_chunk(TimePoint now);

    std::vector<std::shared_ptr<feed::Feed>> channels_;
    Limits limits_;
    feed::FrameCallback on_frame_;
    std::optional<Configuration> configuration_;
    std::uint32_t epoch_ = 0;
    std::uint32_t request_id_ = 0; ///< of the Configure that was granted last
    Adapter adapter_;
    Credits credits_;
    Share bytes_;   ///< in flight
    Share pixels_;  ///< of the views that the server makes for it
    Share cameras_; ///< 1 while it has one of its own
    RateLimit messages_;
    bool is_flooded_ = false;
    bool lacks_budget_ = false; ///< the frame in the mailbox has to wait for bytes of others
    Mailbox<feed::FramePtr> mailbox_;
    std::optional<Sending> sending_;
    std::uint64_t key_frame_id_ = 0; ///< that the client has; 0: none
    std::deque<v1::ServerMessage> answers_;
    std::optional<Departure> departure_; ///< GoingAway is to be sent
    std::optional<TimePoint> cut_at_;    ///< set when GoingAway was sent
    std::optional<CloseReason> close_reason_;
    TimePoint next_heartbeat_;
    TimePoint configure_by_;
    feed::Pace pace_;      ///< the client's rate cap
    StartRhythm rhythm_;   ///< of frames that are sent
    bool is_full_ = false; ///< the feed knows that a frame waits
    DropReason full_because_ = DropReason::kNoCredit; ///< when a frame waited last
    TimePoint has_room_since_{};                      ///< when it stopped waiting
    SessionCounts counts_;
    log::Quota lines_;
    SteeringDesk steering_;
    FrameTimings timings_;
    feed::OwnFeed own_feed_; ///< none unless it has a camera of its own
    feed::Subscription subscription_; ///< last: ends before what its callback leads to
};

} // namespace fieldcast::session
