// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/session/agreement.h"
#include "server/session/frames_in_flight.h"
#include "server/session/mailbox.h"
#include "server/session/session_counts.h"
#include "server/session/start_rhythm.h"

#include <map>
#include <optional>

namespace fieldcast::session {

/// Sends one client the newest frame of its configuration whenever the frames in flight allow it, and reports to the
/// feed whether a frame waits. Not thread-safe. Memory is bounded: one frame in the mailbox and one being sent.
class FrameSender {
public:
    /// `agreement` and `counts` must outlive the last call. `bytes_of_peer` may be null: no limit.
    FrameSender(Agreement& agreement, SessionCounts& counts, std::uint64_t max_bytes_in_flight,
                std::shared_ptr<Budget> bytes_of_peer)
        : agreement_(agreement), counts_(counts), in_flight_(max_bytes_in_flight, std::move(bytes_of_peer)) {}

    /// A frame of the channel was published.
    void on_frame(const feed::FramePtr& frame, TimePoint now);

    /// The client has handled a frame.
    void acknowledged(const v1::FrameAck& ack, TimePoint now);

    /// Begins the epoch of a new configuration: drops the frames of the one before. Returns the message about the frame
    /// that was being sent, if there was one.
    std::optional<v1::FrameAborted> begin_epoch();

    /// Drops the frame in the mailbox, if there is one; a frame that was begun is completed.
    void drop_waiting(DropReason reason);

    /// The next chunk of the frame being sent, or of the waiting one if it may be begun; empty: nothing to send now.
    std::optional<wire::WireChunk> next(TimePoint now);

    FramesInFlight& in_flight() { return in_flight_; }
    const FramesInFlight& in_flight() const { return in_flight_; }

private:
    /// A frame between its header chunk and its trailer.
    struct Sending {
        FrameKey key;
        wire::WireFrame frame;
        std::size_t next_chunk = 0;
        wire::ServerTimes times;
        std::map<wire::PlaneChoice, std::uint64_t> plane_bytes;
    };

    DropReason waiting_reason() const; ///< why the frame in the mailbox is not being sent
    void miss_frame(const feed::EncodedFrame& frame, DropReason reason);
    void update_room(TimePoint now); ///< reports to the feed whether a frame waits
    void begin_frame(TimePoint now); ///< takes it from the mailbox, if there is one and it may be sent
    wire::WireFrame chunks_of(const feed::EncodedFrame& frame) const;
    std::map<wire::PlaneChoice, std::uint64_t> plane_bytes_of(const feed::EncodedFrame& frame,
                                                              const wire::WireFrame& chunks) const;
    bool has_key_frame_of(const feed::EncodedFrame& frame) const; ///< the client has it, or `frame` is it
    void set_key_frame(std::uint64_t frame_id);                   ///< that the client has; 0: none
    wire::WireChunk next_chunk(TimePoint now);

    Agreement& agreement_;
    SessionCounts& counts_;
    FramesInFlight in_flight_;
    Mailbox<feed::FramePtr> mailbox_;
    std::optional<Sending> sending_;
    std::uint64_t key_frame_id_ = 0; ///< that the client has; 0: none
    StartRhythm rhythm_;             ///< of the frames that are sent
    bool lacks_budget_ = false;      ///< the frame in the mailbox waits for bytes of its peer's budget
    bool is_full_ = false;           ///< the feed knows that a frame waits
    DropReason full_because_ = DropReason::kNoCredit; ///< when a frame waited last
    TimePoint has_room_since_{};                      ///< when it stopped waiting
};

} // namespace fieldcast::session
