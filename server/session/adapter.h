// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/session/ladder.h"
#include "server/session/level_controller.h"

#include <optional>

namespace fieldcast::session {

/// Fits the configuration of one client to its connection, if the client allows that: decides when to take another rung
/// of the ladder. The session makes the change, which is an ordinary epoch. Not thread-safe.
class Adapter {
public:
    /// The client asked for `wanted` and was granted `granted`: level 0. Without `wanted.adaptation` the level stays 0.
    void configured(const v1::Configure& wanted, const Configuration& granted);

    /// The first chunk of a frame with `bytes` of payload is handed to the transport.
    void begun(FrameKey key, std::uint64_t bytes, TimePoint now);

    /// The rest of the frame will not be sent.
    void aborted(FrameKey key) { meter_.aborted(key); }

    /// The client has handled a frame and spent `decode_time` on it.
    void acknowledged(const v1::FrameAck& ack, std::chrono::nanoseconds decode_time, TimePoint now);

    /// A frame was dropped because older ones are still in flight.
    void missed() {
        if (controller_) {
            controller_->miss();
        }
    }

    /// The change that is due now, at most one per call.
    std::optional<LevelChange> due(TimePoint now);

    /// The Configure that brings about `change`.
    v1::Configure configure(const LevelChange& change) const { return ladder_->configure(rung(change)); }

    /// The change that `due` returned last was not possible.
    void refused() { controller_->refused(); }

    /// The message that announces `change` to the client.
    v1::Adapted to_message(const LevelChange& change) const;

    /// Current rung of the ladder; 0: the client gets what it asked for.
    std::size_t level() const { return controller_ ? controller_->level() : 0; }

private:
    const Rung& rung(const LevelChange& change) const { return ladder_->rungs()[change.level]; }

    LinkMeter meter_; ///< kept across configurations: the connection is the same
    std::optional<Ladder> ladder_; ///< unset: the client does not want changes
    std::optional<LevelController> controller_; ///< set with `ladder_`
    std::uint32_t epoch_ = 0; ///< of the frame begun last; older samples belong to another rung
};

} // namespace fieldcast::session
