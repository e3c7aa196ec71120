// SPDX-License-Identifier: Apache-2.0
#include "server/channel/channel.h"

#include "core/base/log.h"
#include "core/gpu/command_recorder.h"
#include "server/channel/frame_encoder.h"
#include "server/feed/frame_interval.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>

namespace fieldcast::channel {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLongestPause{500}; ///< longer pauses make the scene jump

/// Sleeps until `time`, or until stopped.
void wait_until(Clock::time_point time, const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    never.wait_until(lock, stop, time, [] { return false; });
}

/// Sleeps until a frame may follow the one begun at `begin`, or until stopped. The rate may change meanwhile.
void wait_for_next_frame(const feed::Feed& feed, Clock::time_point begin, const std::stop_token& stop) {
    constexpr std::chrono::milliseconds kLook{100};
    auto due = begin + feed::frame_interval(feed.frames_per_second());
    while (Clock::now() < due && !stop.stop_requested()) {
        wait_until(std::min(due, Clock::now() + Clock::duration(kLook)), stop);
        due = begin + feed::frame_interval(feed.frames_per_second());
    }
}

feed::ChannelInfo with_memory(feed::ChannelInfo info, std::shared_ptr<feed::ViewMemory> memory) {
    info.view_memory = std::move(memory);
    return info;
}

/// Whether all work on it has ended.
bool is_lost(const gpu::Device& device) {
    try {
        gpu::CommandRecorder recorder(device);
        recorder.submit();
        return false;
    } catch (const std::exception&) {
        return true;
    }
}

} // namespace

Channel::Channel(const Shared& shared, const ChannelChoice& choice)
    : device_(shared.device), renderer_(shared.device, shared.settings, choice),
      clock_(shared.settings, renderer_.scene()),
      feed_(std::make_shared<feed::Feed>(with_memory(renderer_.info(), shared.view_memory))),
      metrics_(shared.registry, feed_->info().name), place_(shared.turns),
      encode_thread_([this](const std::stop_token& stop) { run([&] { encode_loop(stop); }); }),
      render_thread_([this](const std::stop_token& stop) { run([&] { render_loop(stop); }); }) {}

Channel::Channel(const Shared& shared, const SettledChannel& settled, Client client)
    : device_(shared.device), renderer_(shared.device, shared.settings, settled),
      clock_(shared.settings, renderer_.scene(), client.begin), client_(std::move(client)), feed_(client_.feed),
      metrics_(shared.registry, feed_->info().name), place_(shared.turns),
      encode_thread_([this](const std::stop_token& stop) { run([&] { encode_loop(stop); }); }),
      render_thread_([this](const std::stop_token& stop) { run([&] { render_loop(stop); }); }) {}

Channel::~Channel() {
    render_thread_.request_stop(); // both before either is joined, because each may wait for the other
    encode_thread_.request_stop();
}

template <class Work> void Channel::run(const Work& work) {
    try {
        work();
    } catch (const std::exception& problem) {
        fail(problem.what());
    }
}

void Channel::fail(const char* problem) {
    log::error("channel failed", {{"channel", feed_->info().name}, {"problem", problem}});
    feed_->set_failed();
    const auto server = client_.server.lock();
    if (server != nullptr && is_lost(device_)) {
        server->set_failed();
    }
}

void Channel::render_loop(const std::stop_token& stop) {
    std::uint64_t frame_id = 0;
    std::uint64_t reported_samples = 0;
    while (wait_for_demand(stop)) {
        forget_views();
        const auto begin = Clock::now();
        const feed::Demand demand = feed_->demand(begin);
        if (demand.empty() && !demand.is_awaited) {
            continue; // the last subscriber has just left
        }
        std::optional<RenderedFrame> frame = render_in_turn(++frame_id, demand, stop);
        if (!frame) {
            return;
        }
        log_frame(*frame);
        const std::uint64_t invalid_samples = renderer_.invalid_sample_count();
        metrics_.count_rendered(*frame, invalid_samples - std::min(invalid_samples, reported_samples));
        if (invalid_samples > reported_samples) {
            log::warn("invalid samples", {{"channel", feed_->info().name}, {"count", invalid_samples}});
            reported_samples = invalid_samples;
        }
        if (!demand.empty() && !rendered_.put(std::move(*frame), stop)) {
            return;
        }
        wait_for_next_frame(*feed_, begin, stop);
    }
}

void Channel::forget_views() {
    if (const auto wanted = feed_->surplus(Clock::now())) {
        renderer_.forget_views(*wanted);
        feed_->forgot_all_but(*wanted);
        log::debug("views forgotten", {{"channel", feed_->info().name}, {"wanted_pixels", wanted->view_pixels()}});
    }
}

std::optional<RenderedFrame> Channel::render_in_turn(std::uint64_t frame_id, const feed::Demand& demand,
                                                     const std::stop_token& stop) {
    const auto asked = Clock::now();
    const auto turn = place_.wait(stop);
    if (!turn) {
        return std::nullopt;
    }
    const auto begin = Clock::now();
    RenderedFrame frame = renderer_.render(frame_id, next_moment(begin), demand);
    const auto used = Clock::now() - begin;
    metrics_.observe_turn({.waited = begin - asked, .used = used});
    if (client_.used) {
        client_.used(used);
    }
    return frame;
}

FrameMoment Channel::next_moment(Clock::time_point now) {
    FrameMoment moment = clock_.next(now);
    if (feed_->steering() != nullptr) {
        moment.pose = feed_->steering()->sample();
        moment.cut = moment.cut || (moment.pose && moment.pose->cut);
    }
    return moment;
}

bool Channel::wait_for_demand(const std::stop_token& stop) {
    const auto begin = Clock::now();
    const bool has_demand = feed_->wait_for_demand(stop);
    if (Clock::now() - begin > kLongestPause) {
        clock_.resume();
    }
    return has_demand;
}

void Channel::encode_loop(const std::stop_token& stop) {
    FrameEncoder encoder;
    while (auto frame = rendered_.take(stop)) {
        const auto begin = Clock::now();
        const feed::FramePtr encoded = encoder.encode(std::move(*frame), begin);
        const std::chrono::duration<double, std::milli> encode_time = Clock::now() - begin;
        metrics_.count_encoded(*encoded, encode_time);
        log::debug(
            "frame encoded",
            {{"frame", encoded->header.frame_id}, {"key_frame", encoded->key_frame_id}, {"ms", encode_time.count()}});
        feed_->publish(encoded);
    }
}

void Channel::log_frame(const RenderedFrame& frame) const {
    const double render_ms = static_cast<double>(frame.times.render_end_ns - frame.times.render_begin_ns) * 1e-6;
    log::debug("frame rendered", {{"channel", feed_->info().name},
                                  {"frame", frame.header.frame_id},
                                  {"scene_time_s", static_cast<double>(frame.header.scene_time_ns) * 1e-9},
                                  {"cut", frame.header.cut},
                                  {"ms", render_ms}});
    for (const StageTime& time : frame.header.render_times) {
        log::debug("stage", {{"frame", frame.header.frame_id}, {"stage", time.stage}, {"ms", time.ms}});
    }
}

} // namespace fieldcast::channel
