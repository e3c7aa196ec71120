// SPDX-License-Identifier: Apache-2.0
#include "server/recording/replay.h"

#include "core/base/log.h"
#include "core/lightfield/frame_rate.h"
#include "server/feed/frame_interval.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>

namespace fieldcast::recording {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::nanoseconds;

constexpr std::chrono::milliseconds kLongestDelay{500}; ///< a replay that is later restarts its clock

feed::ChannelInfo info_of(const Recording& recording, const ReplaySetup& setup) {
    feed::ChannelInfo info = recording.info();
    info.name = setup.name.empty() ? info.name : setup.name;
    info.frames_per_second = setup.frames_per_second.value_or(info.frames_per_second);
    return info;
}

/// Time from the first frame to its repetition; the last frame is shown for the average frame interval.
nanoseconds loop_length(const Recording& recording) {
    const auto& frames = recording.frames();
    const nanoseconds shown(frames.back().mark.at_ns);
    const bool has_times = frames.size() > 1 && shown.count() > 0;
    return shown + (has_times ? shown / static_cast<std::int64_t>(frames.size() - 1)
                              : feed::frame_interval(recording.info().frames_per_second));
}

/// Sleeps until `time`; false: stopped.
bool wait_until(Clock::time_point time, const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    never.wait_until(lock, stop, time, [] { return false; });
    return !stop.stop_requested();
}

/// Times of a replayed frame: nothing is rendered or encoded, so for clients that measure all of it happens now.
wire::ServerTimes times_now() {
    const std::int64_t now_ns = nanoseconds(Clock::now().time_since_epoch()).count();
    return {.pose_sampled_ns = now_ns, .render_begin_ns = now_ns, .render_end_ns = now_ns, .encode_end_ns = now_ns};
}

} // namespace

Replay::Replay(const ReplaySetup& setup, metrics::Registry& registry)
    : recording_(setup.file), loop_length_(loop_length(recording_)),
      feed_(std::make_shared<feed::Feed>(info_of(recording_, setup))),
      frames_(registry.counter({"fieldcast_replayed_frames_total", "Frames of a recording that were published."},
                               {{"channel", feed_->info().name}})),
      damaged_(registry.counter({"fieldcast_replay_damaged_frames_total", "Frames of a recording that cannot be read."},
                                {{"channel", feed_->info().name}})) {
    if (setup.frames_per_second) {
        interval_ = feed::frame_interval(*setup.frames_per_second);
        loop_length_ = *interval_ * static_cast<std::int64_t>(recording_.frames().size());
    }
    const std::chrono::duration<double> loop_s = loop_length_;
    const double frames_per_second = static_cast<double>(recording_.frames().size()) / loop_s.count();
    if (!(frames_per_second <= 1.001 * static_cast<double>(kMaxFramesPerSecond))) { // times are whole nanoseconds
        log::warn("recording faster than it is replayed", {{"file", setup.file.string()},
                                                           {"frames_per_second", frames_per_second},
                                                           {"replayed", kMaxFramesPerSecond}});
    }
    if (const auto& ignored = recording_.ignored()) {
        log::warn("recording not finished", {{"file", setup.file.string()}, {"ignored", *ignored}});
    }
    thread_ = std::jthread([this](const std::stop_token& stop) {
        try {
            publish_frames(stop);
        } catch (const std::exception& problem) {
            log::error("channel failed", {{"channel", feed_->info().name}, {"problem", problem.what()}});
            feed_->set_failed();
        }
    });
}

void Replay::publish_frames(const std::stop_token& stop) {
    Place place;
    Clock::time_point begin{};    // of the first loop; moved forward after a delay
    Clock::time_point earliest{}; // for the next frame, also while the replay catches up
    while (feed_->wait_for_subscribers(stop)) {
        const std::shared_ptr<feed::EncodedFrame> frame = frame_at(place); // read ahead of its time
        const auto now = Clock::now();
        if (now > begin + time_of(place) + kLongestDelay) {
            begin = now - std::chrono::duration_cast<Clock::duration>(time_of(place));
        }
        if (!wait_until(std::max(begin + time_of(place), earliest), stop)) {
            return;
        }
        earliest = Clock::now() + feed::frame_interval(kMaxFramesPerSecond);
        if (frame != nullptr) {
            frame->times = times_now();
            feed_->publish(frame);
            frames_.add();
        }
        const bool is_last = place.frame + 1 == recording_.frames().size();
        place = is_last ? Place{.loop = place.loop + 1} : Place{.loop = place.loop, .frame = place.frame + 1};
    }
}

std::shared_ptr<feed::EncodedFrame> Replay::frame_at(Place place) {
    auto read = recording_.read(place.frame);
    if (!read) {
        damaged_.add();
        log::warn("frame not replayed", {{"channel", feed_->info().name}, {"problem", read.error().message}});
        return nullptr;
    }
    const std::uint64_t id = id_of(place.loop, read->header.frame_id);
    const std::uint64_t key_id = read->key_frame_id == 0 ? 0 : id_of(place.loop, read->key_frame_id);
    const bool is_cut = place.frame == 0 || read->header.cut;
    auto frame = std::make_shared<feed::EncodedFrame>(std::move(*read));
    frame->header.frame_id = id;
    frame->header.cut = is_cut;
    frame->key_frame_id = key_id;
    if (frame->source) {
        frame->source->header.frame_id = id;
        frame->source->header.cut = is_cut;
        frame->source->key_frame_id = key_id;
    }
    for (wire::EncodedViews& views : frame->views) {
        views.header.frame_id = id;
        views.header.cut = is_cut;
        views.key_frame_id = key_id;
    }
    return frame;
}

// Ids of a loop are the recorded ones plus an offset, so that they continue those of the loop before.
std::uint64_t Replay::id_of(std::uint64_t loop, std::uint64_t recorded_id) const {
    const std::uint64_t first = recording_.frames().front().mark.frame_id;
    const std::uint64_t span = recording_.frames().back().mark.frame_id - first + 1;
    return loop * span + (recorded_id - first) + 1;
}

nanoseconds Replay::time_of(Place place) const {
    const auto since_loop = interval_ ? *interval_ * static_cast<std::int64_t>(place.frame)
                                      : nanoseconds(recording_.frames()[place.frame].mark.at_ns);
    return loop_length_ * static_cast<std::int64_t>(place.loop) + since_loop;
}

} // namespace fieldcast::recording
