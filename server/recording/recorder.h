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

/// What to record of a channel, and where.
struct RecorderSetup {
    std::filesystem::path file;
    std::vector<feed::Selection> selections; ///< every frame of the file has all of them
    std::uint64_t max_frames = 0;   ///< ends then; 0: when it is destroyed
};

/// Records a channel as one of its clients would watch it, so the channel never sleeps meanwhile. Never slows it:
/// frames that the disk is too slow for are left out and counted.
class Recorder {
public:
    /// `registry` must outlive it. Throws UserError if the file cannot be written or the channel refuses.
    Recorder(const std::shared_ptr<feed::Feed>& feed, RecorderSetup setup, metrics::Registry& registry);
    ~Recorder(); ///< finishes the file

    bool has_ended() const { return has_ended_; } ///< max_frames were written, or the disk refused

private:
    /// Frames between the channel's thread and ours. Outlives the recorder as long as the channel may still call.
    struct Queue {
        Guarded<std::deque<feed::FramePtr>> waiting;
        std::condition_variable changed;
    };

    feed::FrameCallback taker();
    void write_frames(const std::stop_token& stop);
    void write(const feed::FramePtr& frame);
    feed::FramePtr next(const std::stop_token& stop); ///< null: stopped, and all is written

    const RecorderSetup setup_;
    const std::string channel_;
    metrics::Counter& frames_;
    metrics::Counter& bytes_;
    metrics::Counter& lost_;
    RecordingWriter writer_;
    std::atomic<bool> has_ended_ = false;
    const std::shared_ptr<Queue> queue_ = std::make_shared<Queue>();
    std::vector<feed::Subscription> subscriptions_; ///< of the writing thread, once it runs
    std::jthread thread_;
};

} // namespace fieldcast::recording
