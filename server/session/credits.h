// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

namespace fieldcast::session {

using TimePoint = std::chrono::steady_clock::time_point;

inline constexpr std::uint32_t kMinCredits = 2;
inline constexpr std::uint32_t kMaxCredits = 8;

/// A frame of one stream. Epochs tell channels apart, whose frame ids may collide.
struct FrameKey {
    std::uint32_t epoch = 0;
    std::uint64_t frame_id = 0;

    bool operator==(const FrameKey&) const = default;
};

/// Bounds what was sent and not yet acknowledged: a finished write does not mean that the peer has read it.
/// At most ceil(fps · (min RTT + decode time)) + 1 frames, clamped to 2 … 8, and a number of bytes.
class Credits {
public:
    Credits(double frames_per_second, std::uint64_t max_bytes) : fps_(frames_per_second), max_bytes_(max_bytes) {}

    /// Room for one more frame? A frame larger than the byte cap may go alone.
    bool allow(std::uint64_t frame_bytes) const;

    /// A frame is being sent.
    void spend(FrameKey frame, std::uint64_t frame_bytes, TimePoint now);

    /// Its last chunk was handed to the transport: the round trip starts.
    void sent(FrameKey frame, TimePoint now);

    /// The client has handled it, having decoded for `decode_time` of its own clock. False: nothing to give back
    /// (a repetition, or never sent).
    bool acknowledged(FrameKey frame, std::chrono::nanoseconds decode_time, TimePoint now);

    /// It was aborted.
    void give_back(FrameKey frame);

    /// The frames still in flight belong to an earlier configuration, the limits to the new one.
    void configure(double frames_per_second, std::uint64_t max_bytes);

    std::uint32_t limit() const;
    std::uint32_t in_flight() const { return static_cast<std::uint32_t>(frames_.size()); }
    std::uint64_t bytes_in_flight() const;

    /// When the oldest unacknowledged frame was begun.
    std::optional<TimePoint> oldest() const;

    /// Smallest round trip of the last 10 to 20 s; unset until the first acknowledgement.
    std::optional<std::chrono::nanoseconds> min_round_trip() const;

private:
    struct Frame {
        FrameKey key;
        std::uint64_t bytes = 0;
        TimePoint begun;
        std::optional<TimePoint> sent;
    };

    void add_round_trip(std::chrono::nanoseconds round_trip, TimePoint now);

    double fps_;
    std::uint64_t max_bytes_;
    std::deque<Frame> frames_; ///< oldest first; at most kMaxCredits
    std::chrono::nanoseconds decode_time_{0};
    std::optional<std::chrono::nanoseconds> window_min_; ///< of the window that began at `window_begin_`
    std::optional<std::chrono::nanoseconds> previous_window_min_;
    TimePoint window_begin_{};
};

} // namespace fieldcast::session
