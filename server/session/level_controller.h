// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/session/link_meter.h"

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

namespace fieldcast::session {

/// Why the level changed.
enum class LevelReason : std::uint8_t {
    kQueueDelay, ///< frames waited too long
    kRecovered,  ///< frames have not waited too long for a while
};

/// A decision to change the level, with the measurement behind it.
struct LevelChange {
    std::size_t level = 0; ///< new level
    LevelReason reason = LevelReason::kQueueDelay;
    std::chrono::milliseconds queue_delay{0};   ///< smallest in the window before the decision
    std::uint64_t delivered_bytes_per_second = 0; ///< in that window
};

/// Chooses how much a client is sent: level 0 is what it asked for, each further level costs less. The caller passes
/// the time, so tests may use any. Not thread-safe.
///
/// The queue delay is the *smallest* value in a window of at least half a second and three frames: jitter and single
/// losses leave some frames undelayed, a standing queue does not.
/// Down, as far as the excess requires: after one window above the delay bound, or after two windows in a row above two
/// fifths of it in which more than a tenth of the frames could not be begun. In the latter case credits keep the queue
/// short by dropping frames.
/// Up, by one level: after a time below half the bound. If that step is soon taken back, the next wait is twice as
/// long.
class LevelController {
public:
    /// `costs`: expected bytes per second of each level, in any unit, falling; at least one.
    LevelController(std::vector<double> costs, std::chrono::milliseconds max_queue_delay);

    /// A frame was acknowledged.
    void add(const LinkSample& sample, TimePoint now);

    /// A frame was dropped because older ones are still in flight.
    void miss() { ++window_.missed; }

    /// The level change that is due now, if any. It counts as made unless `refused` is called.
    std::optional<LevelChange> decide(TimePoint now);

    /// The change that `decide` returned last could not be made.
    void refused();

    std::size_t level() const { return level_; }

    static constexpr std::chrono::milliseconds kWindow{500};
    static constexpr std::size_t kWindowFrames = 3;
    static constexpr std::chrono::seconds kFirstPatience{5};  ///< before a step up
    static constexpr std::chrono::seconds kLongestPatience{160};
    static constexpr std::chrono::seconds kProbation{30}; ///< a step up that lasts this long was right

private:
    struct Window {
        std::optional<TimePoint> begin; ///< time of the first sample
        std::size_t frames = 0;
        std::size_t missed = 0;
        std::uint64_t bytes = 0; ///< after the first sample
        std::chrono::nanoseconds standing_delay{0};
    };

    std::optional<LevelChange> step_down(const LevelChange& measured, double missed_share);
    std::size_t level_for(double wanted_cost) const; ///< below the current one; the current one if there is none
    std::optional<LevelChange> step_up(const LevelChange& measured, TimePoint now);
    void move_to(std::size_t level);

    const std::vector<double> costs_;
    const std::chrono::milliseconds max_queue_delay_;
    std::size_t level_ = 0;
    std::size_t previous_level_ = 0;
    std::optional<std::size_t> refused_level_; ///< skipped on the next step down
    Window window_;
    bool starved_before_ = false; ///< too many frames were missed in the window before
    std::optional<TimePoint> calm_since_; ///< since when the delay has stayed below half the bound
    std::optional<TimePoint> stepped_up_; ///< time of the last step up; unset: none is on probation
    std::chrono::seconds patience_{kFirstPatience}; ///< calm time before the next step up
};

} // namespace fieldcast::session
