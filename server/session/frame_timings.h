// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/timing/frame_timing.h"
#include "server/feed/encoded_frame.h"
#include "server/session/credits.h"

#include "fieldcast/v1/light_field.pb.h"

#include <deque>
#include <string>
#include <vector>

namespace fieldcast::session {

/// The part of a timing record that the channel knows: when `frame` was rendered and encoded.
timing::MadeFrame made_frame(const std::string& channel, const feed::EncodedFrame& frame);

/// Collects the timing records of one client's frames from the session's sending and the client's acknowledgements. A
/// record is finished when the client has reported the frame's outcome, or when kMaxPending younger records are
/// unfinished. Not thread-safe.
class FrameTimings {
public:
    /// Starts recording. Before, all other functions do nothing.
    void enable() { is_enabled_ = true; }

    /// The first chunk of `frame`, with `payload_bytes` in all, is handed to the transport.
    void begun(FrameKey key, const std::string& channel, const feed::EncodedFrame& frame, std::uint64_t payload_bytes);
    void sent(FrameKey key, const wire::ServerTimes& times);
    void aborted(FrameKey key);
    void acknowledged(const v1::FrameAck& ack);

    /// The client has gone: finishes all records.
    void end();

    /// The records that were finished since the last call; at most the newest kMaxPending of them.
    std::vector<timing::DeliveredFrame> take_finished();

    static constexpr std::size_t kMaxPending = 32;

private:
    using Records = std::deque<timing::DeliveredFrame>;
    Records::iterator find(FrameKey key);
    void finish(Records::iterator record);

    bool is_enabled_ = false;
    Records pending_; ///< oldest first
    Records finished_;
};

} // namespace fieldcast::session
