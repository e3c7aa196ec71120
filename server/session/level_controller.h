// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/session/link_meter.h"

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

namespace fieldcast::session {

/// Why a level was left.
enum class LevelReason : std::uint8_t {
    kQueueDelay, ///< frames waited too long
    kRecovered,  ///< they have not for a while
};

struct LevelChange {
    std::size_t level = 0;
    LevelReason reason = LevelReason::kQueueDelay;
    std::chrono::milliseconds queue_delay{0};   ///< standing, when it was decided
    std::uint64_t delivered_bytes_per_second = 0; ///< meanwhile
};

/// Chooses how much a client is sent: level 0 is what it asked for, each further level costs less. Time is handed in,
/// so it can be tested with any.
///
/// Delay is judged by the *smallest* value in a window of half a second and three frames at least: jitter and single
/// losses leave some frames undelayed, a queue that stands does not. Above the bound it goes down at once, as far as
/// the excess says is needed; also after two windows above two fifths of it in which more than a tenth of the frames
/// could not be begun, because then credits keep the queue short at the price of frames. It goes up by one level after
/// a time below half the bound; if that has to be taken back soon, it waits twice as long the next time.
class LevelController {
public:
    /// `costs`: expected bytes per second of each level, in any unit, falling; at least one.
    LevelController(std::vector<double> costs, std::chrono::milliseconds max_queue_delay);

    void add(const LinkSample& sample, TimePoint now);

    /// A frame was dropped because older ones are still on the way.
    void miss() { ++window_.missed; }

    /// The level to change to, if it is time to. What is returned counts as done, unless `refused` is called.
    std::optional<LevelChange> decide(TimePoint now);

    /// The change that `decide` returned last could not be made.
    void refused();

    std::size_t level() const { return level_; }

    static constexpr std::chrono::milliseconds kWindow{500};
    static constexpr std::size_t kWindowFrames = 3;
    static constexpr std::chrono::seconds kFirstPatience{5};  ///< before a step up
    static constexpr std::chrono::seconds kLongestPatience{160};
    static constexpr std::chrono::seconds kProbation{30}; ///< a step up that survives so long was right

private:
    struct Window {
        std::optional<TimePoint> begin; ///< the first sample
        std::size_t frames = 0;
        std::size_t missed = 0;
        std::uint64_t bytes = 0; ///< after the first sample
        std::chrono::nanoseconds standing_delay{0};
    };

    std::optional<LevelChange> step_down(const LevelChange& measured, double missed_share);
    std::size_t level_for(double wanted_cost) const; ///< below this one; this one if there is none
    std::optional<LevelChange> step_up(const LevelChange& measured, TimePoint now);
    void move_to(std::size_t level);

    const std::vector<double> costs_;
    const std::chrono::milliseconds max_queue_delay_;
    std::size_t level_ = 0;
    std::size_t previous_level_ = 0;
    std::optional<std::size_t> refused_level_; ///< passed over on the next way down
    Window window_;
    bool starved_before_ = false; ///< frames were missing in the window before
    std::optional<TimePoint> calm_since_; ///< below half the bound, without interruption
    std::optional<TimePoint> stepped_up_; ///< last; unset: no step up is on probation
    std::chrono::seconds patience_{kFirstPatience};
};

} // namespace fieldcast::session
