// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/session/ladder.h"
#include "server/session/level_controller.h"

#include <optional>

namespace fieldcast::session {

/// Fits what one client gets to its connection, if it allows that: knows the ladder of its configuration and says when
/// to take another rung. The session makes the change, which is an ordinary epoch.
class Adapter {
public:
    /// The client got what it asked for. Without `wanted.adaptation`, nothing is ever changed.
    void configured(const v1::Configure& wanted, const Configuration& granted);

    void begun(FrameKey key, std::uint64_t bytes, TimePoint now);
    void aborted(FrameKey key) { meter_.aborted(key); }
    void acknowledged(const v1::FrameAck& ack, std::chrono::nanoseconds decode_time, TimePoint now);

    /// A frame was dropped because older ones are still on the way.
    void missed() {
        if (controller_) {
            controller_->miss();
        }
    }

    /// The change that is due, at most one per call.
    std::optional<LevelChange> due(TimePoint now);

    /// What to grant for a change.
    v1::Configure configure(const LevelChange& change) const { return ladder_->configure(rung(change)); }

    /// The change that `due` returned was not possible.
    void refused() { controller_->refused(); }

    /// What the client is told about a change.
    v1::Adapted to_message(const LevelChange& change) const;

    std::size_t level() const { return controller_ ? controller_->level() : 0; }

private:
    const Rung& rung(const LevelChange& change) const { return ladder_->rungs()[change.level]; }

    LinkMeter meter_; ///< goes on over configurations: the connection is the same
    std::optional<Ladder> ladder_; ///< unset: the client does not want changes
    std::optional<LevelController> controller_; ///< set with `ladder_`
    std::uint32_t epoch_ = 0; ///< of the frame begun last; samples of older ones say nothing about this rung
};

} // namespace fieldcast::session
