// SPDX-License-Identifier: Apache-2.0
#include "server/channel/channel_clock.h"

#include <cmath>

namespace fieldcast::channel {

namespace {

std::int64_t nanoseconds_of(double seconds) {
    return static_cast<std::int64_t>(std::llround(seconds * 1e9));
}

} // namespace

ChannelClock::ChannelClock(const Settings& settings, const scene::Scene& scene, std::optional<TimePoint> begin)
    : scene_(scene), mode_(settings.clock), fps_(static_cast<double>(settings.frames_per_second)),
      loop_frames_(settings.loop_frames), fixed_time_s_(settings.fixed_time_s), begin_(begin) {}

FrameMoment ChannelClock::next(TimePoint now) {
    begin_ = begin_.value_or(now);
    const bool has_loop_ended = loop_frames_ > 0 && frame_ == loop_frames_;
    frame_ = has_loop_ended ? 0 : frame_;
    FrameMoment moment;
    moment.scene_time_ns = scene_time_ns(now);
    moment.noise_frame = frame_;
    const std::int64_t loop = scene::loop_index(scene_, moment.scene_time_ns);
    moment.cut = is_first_ || has_loop_ended || loop != previous_loop_ || has_jumped_;
    previous_loop_ = loop;
    is_first_ = has_jumped_ = false;
    ++frame_;
    return moment;
}

void ChannelClock::resume() {
    has_jumped_ = mode_ == ClockMode::kReal && !fixed_time_s_ && scene_.duration_s > 0.0;
}

std::int64_t ChannelClock::scene_time_ns(TimePoint now) {
    if (fixed_time_s_) {
        return nanoseconds_of(*fixed_time_s_);
    }
    if (mode_ == ClockMode::kReal) {
        return std::chrono::duration_cast<std::chrono::nanoseconds>(now - *begin_).count();
    }
    return nanoseconds_of(frame_ / fps_);
}

} // namespace fieldcast::channel
