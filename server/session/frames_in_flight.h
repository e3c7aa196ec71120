// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/session/adapter.h"
#include "server/session/budget.h"
#include "server/session/credits.h"
#include "server/session/frame_timings.h"

#include <memory>
#include <string>

namespace fieldcast::session {

/// The frames that one client has not acknowledged: bounds them by its credits and by its peer's byte budget, and
/// measures them for the adaptation and the frame timings. Not thread-safe.
class FramesInFlight {
public:
    /// `budget`: bytes in flight of the client's peer; null: no limit.
    FramesInFlight(std::uint64_t max_bytes, std::shared_ptr<Budget> budget)
        : credits_(1.0, max_bytes), bytes_(std::move(budget)) {}

    /// Another configuration is in force; frames of the one before stay in flight.
    void configure(const Configuration& granted) {
        credits_.configure(static_cast<double>(granted.frames_per_second), granted.max_bytes_in_flight);
    }

    /// Takes the bytes of one more frame from the peer's budget. False: the other sessions of the peer, or all sessions
    /// together, use it up, and nothing was taken.
    bool reserve(std::uint64_t frame_bytes) { return bytes_.resize(credits_.bytes_in_flight() + frame_bytes); }

    /// The first chunk of `frame` is handed to the transport; its `payload_bytes` were reserved.
    void begun(FrameKey key, const std::string& channel, const feed::EncodedFrame& frame, std::uint64_t payload_bytes,
               TimePoint now);

    /// The last chunk was handed to the transport.
    void sent(FrameKey key, const wire::ServerTimes& times, TimePoint now);

    /// The rest of the frame will not be sent.
    void aborted(FrameKey key);

    /// False: a repetition, or a frame that was never sent.
    bool acknowledged(const v1::FrameAck& ack, TimePoint now);

    /// No acknowledgement will come any more: gives the bytes back and finishes the timings.
    void end();

    const Credits& credits() const { return credits_; }
    Adapter& adapter() { return adapter_; }
    const Adapter& adapter() const { return adapter_; }
    FrameTimings& timings() { return timings_; }

private:
    Credits credits_;
    Share bytes_; ///< of the peer's budget
    Adapter adapter_;
    FrameTimings timings_;
};

} // namespace fieldcast::session
