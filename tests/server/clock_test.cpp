// SPDX-License-Identifier: Apache-2.0
#include "server/channel/channel_clock.h"

#include <gtest/gtest.h>

namespace fieldcast::channel {
namespace {

using namespace std::chrono_literals;

class Clock : public testing::Test {
protected:
    Clock() {
        config_.frames_per_second = 10.0F;
        scene_.duration_s = 1.0;
    }

    Settings config_;
    scene::Scene scene_;
    ChannelClock::TimePoint now_{1h};
};

TEST_F(Clock, RealTimeFollowsTheWallClock) {
    ChannelClock clock(config_, scene_);
    EXPECT_EQ(clock.next(now_).scene_time_ns, 0);
    EXPECT_EQ(clock.next(now_ + 700ms).scene_time_ns, 700'000'000);
}

TEST_F(Clock, FramesGoOnByOneInterval) {
    config_.clock = ClockMode::kFrames;
    ChannelClock clock(config_, scene_);
    EXPECT_EQ(clock.next(now_).scene_time_ns, 0);
    EXPECT_EQ(clock.next(now_ + 10s).scene_time_ns, 100'000'000);
}

TEST_F(Clock, CutsAtTheStartAndWhenTheAnimationStartsOver) {
    ChannelClock clock(config_, scene_);
    EXPECT_TRUE(clock.next(now_).cut);
    EXPECT_FALSE(clock.next(now_ + 900ms).cut) << "slow rendering is no cut";
    EXPECT_TRUE(clock.next(now_ + 1100ms).cut);
    EXPECT_FALSE(clock.next(now_ + 1200ms).cut);
}

TEST_F(Clock, CutsAfterAPauseInRealTimeOnly) {
    ChannelClock real(config_, scene_);
    real.next(now_);
    real.resume();
    EXPECT_TRUE(real.next(now_ + 100ms).cut);
    EXPECT_FALSE(real.next(now_ + 200ms).cut);
    config_.clock = ClockMode::kFrames;
    ChannelClock frames(config_, scene_);
    frames.next(now_);
    frames.resume();
    EXPECT_FALSE(frames.next(now_ + 100ms).cut);
}

TEST_F(Clock, LoopsOfFramesRepeatExactly) {
    config_.clock = ClockMode::kFrames;
    config_.loop_frames = 3;
    ChannelClock clock(config_, scene_);
    std::vector<FrameMoment> moments;
    for (int i = 0; i < 6; ++i) {
        moments.push_back(clock.next(now_));
    }
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(moments[i].scene_time_ns, moments[i + 3].scene_time_ns);
        EXPECT_EQ(moments[i].noise_frame, moments[i + 3].noise_frame);
        EXPECT_EQ(moments[i + 3].cut, i == 0);
    }
    EXPECT_NE(moments[0].noise_frame, moments[1].noise_frame);
}

TEST_F(Clock, FixedTimeStands) {
    config_.fixed_time_s = 0.25;
    ChannelClock clock(config_, scene_);
    EXPECT_EQ(clock.next(now_).scene_time_ns, 250'000'000);
    const FrameMoment later = clock.next(now_ + 5s);
    EXPECT_EQ(later.scene_time_ns, 250'000'000);
    EXPECT_FALSE(later.cut);
}

} // namespace
} // namespace fieldcast::channel
