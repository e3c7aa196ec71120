// SPDX-License-Identifier: Apache-2.0
#include "server/session/adapter.h"

#include <algorithm>
#include <vector>

namespace fieldcast::session {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds kUsualQueueDelay{100};
constexpr milliseconds kLongestQueueDelay{10'000};
constexpr std::chrono::seconds kLongestRoundTrip{10}; ///< longest that a client may claim

milliseconds max_queue_delay(const v1::Adaptation& bounds) {
    const milliseconds asked(bounds.max_queue_delay_ms());
    return asked == milliseconds(0) ? kUsualQueueDelay : std::min(asked, kLongestQueueDelay);
}

} // namespace

void Adapter::configured(const v1::Configure& wanted, const Configuration& granted) {
    controller_.reset();
    ladder_.reset();
    if (!wanted.has_adaptation()) {
        return;
    }
    ladder_.emplace(wanted, granted);
    std::vector<double> costs;
    for (const Rung& rung : ladder_->rungs()) {
        costs.push_back(rung.cost);
    }
    controller_.emplace(std::move(costs), max_queue_delay(wanted.adaptation()));
}

void Adapter::begun(FrameKey key, std::uint64_t bytes, TimePoint now) {
    epoch_ = key.epoch;
    meter_.begun(key, bytes, now);
}

void Adapter::acknowledged(const v1::FrameAck& ack, std::chrono::nanoseconds decode_time, TimePoint now) {
    const std::chrono::nanoseconds claimed(ack.clock().round_trip_ns());
    if (claimed > std::chrono::nanoseconds(0) && claimed < kLongestRoundTrip) {
        meter_.add_round_trip(claimed, now);
    }
    const auto sample = meter_.acknowledged({.epoch = ack.epoch(), .frame_id = ack.frame_id()}, decode_time, now);
    if (sample && controller_ && ack.epoch() == epoch_) {
        controller_->add(*sample, now);
    }
}

std::optional<LevelChange> Adapter::due(TimePoint now) {
    return controller_ ? controller_->decide(now) : std::nullopt;
}

v1::Adapted Adapter::to_message(const LevelChange& change) const {
    v1::Adapted message;
    const bool is_down = change.reason == LevelReason::kQueueDelay;
    message.set_level(static_cast<std::uint32_t>(change.level));
    message.set_reason(is_down ? v1::ADAPTATION_REASON_QUEUE_DELAY : v1::ADAPTATION_REASON_RECOVERED);
    message.set_queue_delay_ms(static_cast<std::uint32_t>(std::max<std::int64_t>(change.queue_delay.count(), 0)));
    message.set_delivered_bytes_per_second(change.delivered_bytes_per_second);
    message.set_change(ladder_->change(rung(change)));
    return message;
}

} // namespace fieldcast::session
