// SPDX-License-Identifier: Apache-2.0
#include "server/session/level_controller.h"

#include "core/base/error.h"

#include <algorithm>
#include <utility>

namespace fieldcast::session {

namespace {

/// A level is expected to fit if it needs at most this share of the rate that is delivered now: a queue must drain.
constexpr double kUsableShare = 0.8;

/// Share of frames that may be missed without consequence; client and server are never exactly in step.
constexpr double kAcceptedMisses = 0.1;

/// Share of the delay bound above which missed frames are attributed to the connection. Jitter alone makes frames miss,
/// too, because credits follow the smallest round trip; it delays every frame of half a second by a third of 100 ms
/// (simulated, 50 ± 20 ms each way).
constexpr double kStarvedShare = 0.4;

/// Most levels taken at once on the way down: expected costs are rough.
constexpr std::size_t kLongestStepDown = 3;

} // namespace

LevelController::LevelController(std::vector<double> costs, std::chrono::milliseconds max_queue_delay)
    : costs_(std::move(costs)), max_queue_delay_(max_queue_delay) {
    FC_ASSERT(!costs_.empty(), "level 0 always exists");
}

void LevelController::add(const LinkSample& sample, TimePoint now) {
    if (!window_.begin) {
        window_ = {.begin = now, .frames = 1, .missed = 0, .bytes = 0, .standing_delay = sample.queue_delay};
        return;
    }
    ++window_.frames;
    window_.bytes += sample.bytes;
    window_.standing_delay = std::min(window_.standing_delay, sample.queue_delay);
}

std::optional<LevelChange> LevelController::decide(TimePoint now) {
    if (stepped_up_ && now - *stepped_up_ >= kProbation) {
        stepped_up_.reset();
        patience_ = kFirstPatience;
    }
    if (!window_.begin || window_.frames < kWindowFrames || now - *window_.begin < kWindow) {
        return std::nullopt;
    }
    const Window window = std::exchange(window_, {});
    const double seconds = std::chrono::duration<double>(now - *window.begin).count();
    const LevelChange measured{
        .level = level_,
        .queue_delay = std::chrono::duration_cast<std::chrono::milliseconds>(window.standing_delay),
        .delivered_bytes_per_second = static_cast<std::uint64_t>(static_cast<double>(window.bytes) / seconds)};
    const double missed_share =
        static_cast<double>(window.missed) / static_cast<double>(window.missed + window.frames);
    const bool lacks_frames =
        missed_share > kAcceptedMisses && window.standing_delay > kStarvedShare * max_queue_delay_;
    const bool is_starved = lacks_frames && starved_before_;
    starved_before_ = lacks_frames;
    if (window.standing_delay > max_queue_delay_ || is_starved) {
        calm_since_.reset();
        return step_down(measured, missed_share);
    }
    if (window.standing_delay > max_queue_delay_ / 2) {
        calm_since_.reset();
        return std::nullopt;
    }
    calm_since_ = calm_since_.value_or(now);
    return step_up(measured, now);
}

std::optional<LevelChange> LevelController::step_down(const LevelChange& measured, double missed_share) {
    if (std::exchange(stepped_up_, std::nullopt)) {
        patience_ = std::min<std::chrono::seconds>(2 * patience_, kLongestPatience);
    }
    // A level that needs too much shows in two ways: missed frames, and the delay of the others.
    const auto bound = static_cast<double>(std::max<std::int64_t>(max_queue_delay_.count(), 1));
    const double excess = std::max(1.0, static_cast<double>(measured.queue_delay.count()) / bound);
    const std::size_t level = level_for(costs_[level_] * kUsableShare * (1.0 - missed_share) / excess);
    if (level == level_) {
        return std::nullopt;
    }
    move_to(level);
    LevelChange change = measured;
    change.level = level;
    change.reason = LevelReason::kQueueDelay;
    return change;
}

std::size_t LevelController::level_for(double wanted_cost) const {
    std::size_t best = level_;
    for (std::size_t level = level_ + 1; level < costs_.size() && level <= level_ + kLongestStepDown; ++level) {
        if (level == refused_level_) {
            continue;
        }
        best = level;
        if (costs_[level] <= wanted_cost) {
            break;
        }
    }
    return best;
}

std::optional<LevelChange> LevelController::step_up(const LevelChange& measured, TimePoint now) {
    if (level_ == 0 || now - *calm_since_ < patience_) {
        return std::nullopt;
    }
    move_to(level_ - 1);
    stepped_up_ = now;
    LevelChange change = measured;
    change.level = level_;
    change.reason = LevelReason::kRecovered;
    return change;
}

void LevelController::move_to(std::size_t level) {
    refused_level_.reset();
    starved_before_ = false;
    previous_level_ = std::exchange(level_, level);
    window_ = {};
    calm_since_.reset();
}

void LevelController::refused() {
    refused_level_ = std::exchange(level_, previous_level_);
    if (std::exchange(stepped_up_, std::nullopt)) {
        patience_ = std::min<std::chrono::seconds>(2 * patience_, kLongestPatience);
    }
}

} // namespace fieldcast::session
