// SPDX-License-Identifier: Apache-2.0
#include "server/session/link_meter.h"

#include <algorithm>

namespace fieldcast::session {

namespace {

constexpr std::chrono::seconds kWindow{30};

} // namespace

void LinkMeter::begun(FrameKey key, std::uint64_t bytes, TimePoint now) {
    const bool is_behind =
        std::ranges::any_of(frames_, [&](const Frame& frame) { return frame.key.epoch != key.epoch; });
    frames_.push_back({.key = key, .bytes = bytes, .begun = now, .is_behind_old_epoch = is_behind});
    if (frames_.size() > kMaxCredits) {
        frames_.pop_front();
    }
}

void LinkMeter::aborted(FrameKey key) {
    std::erase_if(frames_, [&](const Frame& frame) { return frame.key == key; });
}

std::optional<LinkSample> LinkMeter::acknowledged(FrameKey key, Nanoseconds decode_time, TimePoint now) {
    const auto found = std::ranges::find(frames_, key, &Frame::key);
    if (found == frames_.end()) {
        return std::nullopt; // a repetition
    }
    const Frame frame = *found;
    frames_.erase(found);
    const Nanoseconds on_the_way = std::max<Nanoseconds>(now - frame.begun - decode_time, Nanoseconds(0));
    add_round_trip(on_the_way, now);
    if (frame.is_behind_old_epoch) {
        return std::nullopt;
    }
    return LinkSample{.bytes = frame.bytes, .queue_delay = on_the_way - *base_round_trip()};
}

void LinkMeter::add_round_trip(Nanoseconds round_trip, TimePoint now) {
    if (!window_min_ || now - window_begin_ >= kWindow) {
        previous_window_min_ = window_min_;
        window_min_ = round_trip;
        window_begin_ = now;
    }
    window_min_ = std::min(*window_min_, round_trip);
}

std::optional<LinkMeter::Nanoseconds> LinkMeter::base_round_trip() const {
    if (!window_min_ || !previous_window_min_) {
        return window_min_;
    }
    return std::min(*window_min_, *previous_window_min_);
}

} // namespace fieldcast::session
