// SPDX-License-Identifier: Apache-2.0
#include "server/session/credits.h"

#include <algorithm>
#include <cmath>

namespace fieldcast::session {

namespace {

using std::chrono::nanoseconds;

constexpr std::chrono::seconds kWindow{10};
constexpr std::chrono::seconds kLongestDecode{10}; ///< longest that a client may claim

double seconds(nanoseconds time) {
    return std::chrono::duration<double>(time).count();
}

} // namespace

bool Credits::allow(std::uint64_t frame_bytes) const {
    return frames_.empty() || (frames_.size() < limit() && bytes_in_flight() + frame_bytes <= max_bytes_);
}

void Credits::spend(FrameKey key, std::uint64_t frame_bytes, TimePoint now) {
    frames_.push_back({.key = key, .bytes = frame_bytes, .begun = now, .sent = {}});
}

void Credits::sent(FrameKey key, TimePoint now) {
    const auto frame = std::ranges::find(frames_, key, &Frame::key);
    if (frame != frames_.end()) {
        frame->sent = now;
    }
}

bool Credits::acknowledged(FrameKey key, nanoseconds decode_time, TimePoint now) {
    const auto frame = std::ranges::find(frames_, key, &Frame::key);
    if (frame == frames_.end() || !frame->sent) {
        return false; // also if the client acknowledges a frame that it cannot have received completely
    }
    decode_time = std::clamp(decode_time, nanoseconds(0), nanoseconds(kLongestDecode));
    add_round_trip(std::max(now - *frame->sent - decode_time, nanoseconds(0)), now);
    decode_time_ = (decode_time_ * 7 + decode_time) / 8;
    frames_.erase(frame);
    return true;
}

void Credits::give_back(FrameKey key) {
    std::erase_if(frames_, [&](const Frame& frame) { return frame.key == key; });
}

void Credits::configure(double frames_per_second, std::uint64_t max_bytes) {
    fps_ = frames_per_second;
    max_bytes_ = max_bytes;
}

void Credits::add_round_trip(nanoseconds round_trip, TimePoint now) {
    if (!window_min_ || now - window_begin_ >= kWindow) {
        previous_window_min_ = window_min_;
        window_min_ = round_trip;
        window_begin_ = now;
    }
    window_min_ = std::min(*window_min_, round_trip);
}

std::optional<nanoseconds> Credits::min_round_trip() const {
    if (!window_min_ || !previous_window_min_) {
        return window_min_;
    }
    return std::min(*window_min_, *previous_window_min_);
}

std::uint32_t Credits::limit() const {
    const double frames = std::ceil(fps_ * seconds(min_round_trip().value_or(nanoseconds(0)) + decode_time_)) + 1.0;
    return static_cast<std::uint32_t>(
        std::clamp(frames, static_cast<double>(kMinCredits), static_cast<double>(kMaxCredits)));
}

std::uint64_t Credits::bytes_in_flight() const {
    std::uint64_t bytes = 0;
    for (const Frame& frame : frames_) {
        bytes += frame.bytes;
    }
    return bytes;
}

std::optional<TimePoint> Credits::oldest() const {
    return frames_.empty() ? std::nullopt : std::optional(frames_.front().begun);
}

} // namespace fieldcast::session
