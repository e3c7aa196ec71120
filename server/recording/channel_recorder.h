// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/feed/feed.h"
#include "server/metrics/registry.h"
#include "server/recording/recording_writer.h"

#include <atomic>
#include <deque>
#include <stop_token>
#include <thread>

namespace fieldcast::recording {

/// Selections of a channel to record, and the file.
struct ChannelRecorderSetup {
    std::filesystem::path file;
    std::vector<feed::Selection> selections; ///< every frame of the file has all of them
    std::uint64_t max_frames = 0;            ///< stops after so many; 0: when it is destroyed
};

/// Records a channel as a subscriber that always has room, so the channel never sleeps meanwhile. It never slows the
/// channel: if the disk is too slow, frames are left out and counted.
class ChannelRecorder {
public:
    /// `registry` must outlive it. Throws UserError if the file cannot be written or the channel refuses.
    ChannelRecorder(const std::shared_ptr<feed::Feed>& feed, ChannelRecorderSetup setup, metrics::Registry& registry);
    ~ChannelRecorder(); ///< finishes the file

    bool has_ended() const { return has_ended_; } ///< max_frames were written, or writing failed

private:
    /// Frames between the channel's thread and the writing thread. Outlives the recorder as long as the channel may
    /// still call.
    struct Queue {
        Guarded<std::deque<feed::FramePtr>> waiting;
        std::condition_variable changed;
    };

    feed::FrameCallback taker(); ///< puts frames into the queue
    void write_frames(const std::stop_token& stop);
    void write(const feed::FramePtr& frame);
    feed::FramePtr next(const std::stop_token& stop); ///< null: stopped, and all frames are written

    const ChannelRecorderSetup setup_;
    const std::string channel_;
    metrics::Counter& frames_;
    metrics::Counter& bytes_;
    metrics::Counter& lost_;
    RecordingWriter writer_;
    std::atomic<bool> has_ended_ = false;
    const std::shared_ptr<Queue> queue_ = std::make_shared<Queue>();
    std::vector<feed::Subscription> subscriptions_; ///< belong to the writing thread once it runs
    std::jthread thread_;
};

} // namespace fieldcast::recording
