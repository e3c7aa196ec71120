// SPDX-License-Identifier: Apache-2.0
#include "server/recording/channel_recorder.h"

#include "core/base/error.h"
#include "core/base/log.h"

namespace fieldcast::recording {

namespace {

constexpr std::size_t kMaxWaiting = 8; ///< frames that wait for the disk

feed::ChannelInfo with_forms(feed::ChannelInfo info, const std::vector<feed::Selection>& selections) {
    info.recorded = selections;
    return info;
}

metrics::Counter& counter(metrics::Registry& registry, const char* name, const char* help, const std::string& channel) {
    return registry.counter({name, help}, {{"channel", channel}});
}

} // namespace

ChannelRecorder::ChannelRecorder(const std::shared_ptr<feed::Feed>& feed, ChannelRecorderSetup setup,
                                 metrics::Registry& registry)
    : setup_(std::move(setup)), channel_(feed->info().name),
      frames_(
          counter(registry, "fieldcast_recorded_frames_total", "Frames that were written to a recording.", channel_)),
      bytes_(counter(registry, "fieldcast_recorded_bytes_total", "Bytes that were written to a recording.", channel_)),
      lost_(counter(registry, "fieldcast_recording_lost_frames_total",
                    "Frames missing in a recording because the disk was too slow.", channel_)),
      writer_(setup_.file, with_forms(feed->info(), setup_.selections)) {
    for (const feed::Selection& selection : setup_.selections) {
        const bool is_first = subscriptions_.empty(); // every subscription gets every frame: one callback is enough
        auto subscription = feed::Feed::subscribe(feed, selection, is_first ? taker() : [](const feed::FramePtr&) {});
        if (!subscription) {
            throw UserError(setup_.file.string() + ": " + subscription.error());
        }
        subscriptions_.push_back(std::move(*subscription));
    }
    log::info("recording", {{"channel", channel_}, {"file", setup_.file.string()}});
    thread_ = std::jthread([this](const std::stop_token& stop) { write_frames(stop); });
}

ChannelRecorder::~ChannelRecorder() {
    thread_.request_stop();
    thread_ = {};
    log::info("recording finished", {{"channel", channel_},
                                     {"file", setup_.file.string()},
                                     {"frames", writer_.frame_count()},
                                     {"bytes", writer_.file_bytes()}});
}

feed::FrameCallback ChannelRecorder::taker() {
    return [queue = queue_, &lost = lost_](const feed::FramePtr& frame) {
        {
            auto waiting = queue->waiting.lock();
            if (waiting->size() >= kMaxWaiting) {
                lost.add();
                return;
            }
            waiting->push_back(frame);
        }
        queue->changed.notify_all();
    };
}

void ChannelRecorder::write_frames(const std::stop_token& stop) {
    try {
        while (!has_ended_) {
            const feed::FramePtr frame = next(stop);
            if (frame == nullptr) {
                break;
            }
            write(frame);
        }
        writer_.finish();
    } catch (const std::exception& problem) {
        log::error("recording failed", {{"channel", channel_}, {"problem", problem.what()}});
    }
    subscriptions_.clear(); // so that the channel may sleep again
    has_ended_ = true;
}

feed::FramePtr ChannelRecorder::next(const std::stop_token& stop) {
    const std::stop_callback wake(stop, [this] {
        { auto waiting = queue_->waiting.lock(); } // else a waiter between its test and its sleep would miss this
        queue_->changed.notify_all();
    });
    auto waiting = queue_->waiting.lock();
    waiting.wait(queue_->changed, [&](const auto& frames) { return stop.stop_requested() || !frames.empty(); });
    if (waiting->empty()) {
        return nullptr;
    }
    const feed::FramePtr frame = std::move(waiting->front());
    waiting->pop_front();
    return frame;
}

void ChannelRecorder::write(const feed::FramePtr& frame) {
    const std::uint64_t before = writer_.file_bytes();
    if (writer_.add(*frame, std::chrono::nanoseconds(frame->times.encode_end_ns))) {
        frames_.add();
        bytes_.add(writer_.file_bytes() - before);
    }
    has_ended_ = setup_.max_frames > 0 && writer_.frame_count() >= setup_.max_frames;
}

} // namespace fieldcast::recording
