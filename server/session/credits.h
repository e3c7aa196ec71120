// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

namespace fieldcast::session {

using TimePoint = std::chrono::steady_clock::time_point;

/// `time` as messages carry it: on the server's steady clock, ns.
inline std::int64_t nanoseconds_of(TimePoint time) {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
}

inline constexpr std::uint32_t kMinCredits = 2;
inline constexpr std::uint32_t kMaxCredits = 8;

/// Identifies a frame of one stream. The epoch is needed because frame ids of two channels may be equal.
struct FrameKey {
    std::uint32_t epoch = 0;
    std::uint64_t frame_id = 0;

    bool operator==(const FrameKey&) const = default;
};

/// Bounds the frames that were sent and are not yet acknowledged, because a finished write does not mean that the peer
/// has read it: at most ceil(fps · (min RTT + decode time)) + 1 frames, clamped to 2 … 8, and a number of bytes.
class Credits {
public:
    Credits(double frames_per_second, std::uint64_t max_bytes) : fps_(frames_per_second), max_bytes_(max_bytes) {}

    /// Whether one more frame may be sent. A frame larger than the byte limit may be sent alone.
    bool allow(std::uint64_t frame_bytes) const;

    /// The first chunk of a frame is handed to the transport.
    void spend(FrameKey frame, std::uint64_t frame_bytes, TimePoint now);

    /// The last chunk was handed to the transport: the round trip starts.
    void sent(FrameKey frame, TimePoint now);

    /// The client has handled the frame and spent `decode_time` on it, by its own clock. False: a repetition, or a
    /// frame that was never sent; nothing changes.
    bool acknowledged(FrameKey frame, std::chrono::nanoseconds decode_time, TimePoint now);

    /// The frame was aborted and is not in flight any more.
    void give_back(FrameKey frame);

    /// Sets the limits of a new configuration; frames of an earlier one stay in flight.
    void configure(double frames_per_second, std::uint64_t max_bytes);

    std::uint32_t limit() const; ///< frames
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
