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

timing::MadeFrame made_frame(const std::string& channel, const feed::EncodedFrame& frame);

/// Collects when the frames of one client were where, from what the session does and what the client acknowledges. A
/// record is finished when the client has said what became of the frame, or when kMaxPending younger ones wait for
/// that.
class FrameTimings {
public:
    /// Off at first: then everything else does nothing.
    void enable() { is_enabled_ = true; }

    void begun(FrameKey key, const std::string& channel, const feed::EncodedFrame& frame, std::uint64_t payload_bytes);
    void sent(FrameKey key, const wire::ServerTimes& times);
    void aborted(FrameKey key);
    void acknowledged(const v1::FrameAck& ack);

    /// Nothing more will be heard: all records are finished.
    void end();

    /// Those that were finished since the last call; at most kMaxPending of them are kept.
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
