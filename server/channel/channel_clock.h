// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/scene.h"
#include "server/channel/settings.h"
#include "server/feed/steering.h"

#include <chrono>
#include <cstdint>
#include <optional>

namespace fieldcast::channel {

/// Scene time of a frame, and the values that depend on it.
struct FrameMoment {
    std::int64_t scene_time_ns = 0;
    bool cut = false;
    std::uint32_t noise_frame = 0; ///< FrameHeader::noise_frame
    std::optional<feed::SteeredPose> pose{}; ///< pose that a steering client requested
};

/// Scene time of one channel.
class ChannelClock {
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    /// `scene` must outlive it. In real time, scene time starts at `begin`, or else with the first frame.
    ChannelClock(const Settings& settings, const scene::Scene& scene, std::optional<TimePoint> begin = std::nullopt);

    /// The moment of the next frame, which is rendered at `now`. The first frame and the start of a loop are cuts.
    FrameMoment next(TimePoint now);

    /// Call it after a pause without clients. In real time the scene has jumped, so the next frame is a cut.
    void resume();

private:
    std::int64_t scene_time_ns(TimePoint now);

    const scene::Scene& scene_;
    const ClockMode mode_;
    const double fps_;
    const std::uint32_t loop_frames_;
    const std::optional<double> fixed_time_s_;
    std::uint32_t frame_ = 0; ///< since the start, or since the loop of `loop_frames_` began
    bool is_first_ = true;
    bool has_jumped_ = false;
    std::optional<TimePoint> begin_;
    std::int64_t previous_loop_ = 0;
};

} // namespace fieldcast::channel
