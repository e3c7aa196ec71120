// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/feed.h"
#include "server/metrics/registry.h"
#include "server/recording/recording.h"

#include <optional>
#include <thread>

namespace fieldcast::recording {

/// Recording to replay, and its settings.
struct ReplaySetup {
    std::filesystem::path file;
    std::string name;                       ///< of the channel; empty: as it was recorded
    std::optional<float> frames_per_second; ///< unset: as it was recorded
};

/// A recording as a channel: publishes its frames in a loop while there are subscribers, never faster than
/// kMaxFramesPerSecond, whatever their recorded times. Frame ids increase from loop to loop; the first frame of a loop
/// is a cut. Needs no device.
class Replay {
public:
    /// `registry` must outlive it. Throws UserError if the file is not a recording.
    Replay(const ReplaySetup& setup, metrics::Registry& registry);

    const std::shared_ptr<feed::Feed>& feed() const { return feed_; }
    std::size_t frame_count() const { return recording_.frames().size(); } ///< of one loop

private:
    /// Position of a frame in the endless sequence of loops.
    struct Place {
        std::uint64_t loop = 0; ///< 0 first
        std::size_t frame = 0; ///< of the recording
    };

    void publish_frames(const std::stop_token& stop);
    std::shared_ptr<feed::EncodedFrame> frame_at(Place place); ///< null: damaged
    std::uint64_t id_of(std::uint64_t loop, std::uint64_t recorded_id) const;
    std::chrono::nanoseconds time_of(Place place) const; ///< since the first frame of the first loop

    Recording recording_;
    std::chrono::nanoseconds loop_length_{0};
    std::optional<std::chrono::nanoseconds> interval_; ///< unset: as recorded
    std::shared_ptr<feed::Feed> feed_;
    metrics::Counter& frames_;
    metrics::Counter& damaged_;
    std::jthread thread_;
};

} // namespace fieldcast::recording
