// SPDX-License-Identifier: Apache-2.0
// Who gets a camera of its own, and that nothing is left of those that have gone.
#include "tests/fixtures/polling.h"
#include "tests/server/camera_factory.h"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>

namespace fieldcast::camera {
namespace {

using namespace std::chrono_literals;
using test::CameraFactory;
using testing::HasSubstr;

constexpr feed::CameraLoad kTenFrames{.frames_per_second = 10.0F, .view_pixels = 1'000'000};

class AdmissionTest : public testing::Test {
protected:
    AdmissionTest() {
        admission_.estimate("hall", {.source_ms = 10.0, .ms_per_view_megapixel = 20.0});
    } // 30 ms a frame

    void observe(Admission::Id id, std::chrono::milliseconds used) {
        for (int i = 0; i < 60; ++i) { // 0.8^58: a millionth of what was is left
            admission_.observe(id, used);
        }
    }

    Admission admission_{{.max_cameras = 4, .max_ms_per_second = 700.0}};
};

TEST_F(AdmissionTest, TheNumberOfCamerasIsLimited) {
    for (Admission::Id id = 1; id <= 4; ++id) {
        EXPECT_FALSE(admission_.admit(id, "hall", {.frames_per_second = 1.0F}).has_value()) << id;
    }
    const auto problem = admission_.admit(5, "hall", {.frames_per_second = 1.0F});
    ASSERT_TRUE(problem.has_value());
    EXPECT_EQ(problem->shortage, Shortage::kCameras);
    EXPECT_THAT(problem->message, HasSubstr("all 4"));
    admission_.leave(2);
    EXPECT_FALSE(admission_.admit(6, "hall", {.frames_per_second = 1.0F}).has_value());
    EXPECT_EQ(admission_.cameras_of("hall"), 4U);
}

TEST_F(AdmissionTest, DeviceTimeIsFrameRateTimesTimeOfAFrame) {
    EXPECT_FALSE(admission_.admit(1, "hall", kTenFrames).has_value());
    EXPECT_FALSE(admission_.admit(2, "hall", kTenFrames).has_value());
    EXPECT_DOUBLE_EQ(admission_.promised_ms_per_second("hall"), 600.0);
    const auto problem = admission_.admit(3, "hall", kTenFrames);
    ASSERT_TRUE(problem.has_value());
    EXPECT_EQ(problem->shortage, Shortage::kTime);
    EXPECT_THAT(problem->message, HasSubstr("300 ms of the device per second asked"));
    EXPECT_THAT(problem->message, HasSubstr("100 of 700 are left"));
    EXPECT_FALSE(admission_.admit(3, "hall", {.frames_per_second = 10.0F, .view_pixels = 0}).has_value()) << "100 ms";
}

TEST_F(AdmissionTest, WhoIsAloneGetsWhatItWants) {
    EXPECT_FALSE(admission_.admit(1, "hall", {.frames_per_second = 240.0F, .view_pixels = 9'000'000}).has_value());
    EXPECT_TRUE(admission_.admit(2, "hall", {.frames_per_second = 0.1F}).has_value());
    admission_.leave(1);
    EXPECT_FALSE(admission_.admit(2, "hall", {.frames_per_second = 0.1F}).has_value());
}

TEST_F(AdmissionTest, WhoIsAloneBesideAnIdleCameraGetsWhatItWants) {
    const feed::CameraLoad all{.frames_per_second = 240.0F, .view_pixels = 9'000'000};
    auto now = Admission::TimePoint(1h);
    admission_.look_at_clock(now);
    EXPECT_FALSE(admission_.admit(1, "hall", all).has_value());
    admission_.look_at_clock(now += 1h);
    EXPECT_TRUE(admission_.admit(2, "hall", all).has_value()) << "the first one is still being made";
    observe(1, 30ms);
    admission_.look_at_clock(now += Admission::kIdleAfter);
    EXPECT_TRUE(admission_.admit(2, "hall", all).has_value());
    admission_.look_at_clock(now += 1s);
    EXPECT_EQ(admission_.promised_ms_per_second("hall"), 0.0) << "it renders nothing";
    EXPECT_FALSE(admission_.admit(2, "hall", all).has_value());
    observe(2, 30ms);
    const double of_one = admission_.promised_ms_per_second("hall");
    EXPECT_GT(of_one, 0.0);
    observe(1, 30ms);
    EXPECT_GT(admission_.promised_ms_per_second("hall"), 1.5 * of_one) << "it renders again, and counts";
    EXPECT_TRUE(admission_.change(2, {.frames_per_second = 241.0F, .view_pixels = 9'000'000}).has_value());
}

TEST_F(AdmissionTest, MoreNeedsRoomAndLessDoesNot) {
    EXPECT_FALSE(admission_.admit(1, "hall", kTenFrames).has_value());
    EXPECT_FALSE(admission_.admit(2, "hall", kTenFrames).has_value());
    EXPECT_TRUE(admission_.change(2, {.frames_per_second = 20.0F, .view_pixels = 1'000'000}).has_value());
    EXPECT_DOUBLE_EQ(admission_.promised_ms_per_second("hall"), 600.0) << "refused: it keeps what it had";
    observe(1, 300ms); // ten times as long as estimated: far more than there is
    EXPECT_FALSE(admission_.change(2, {.frames_per_second = 9.0F, .view_pixels = 1'000'000}).has_value());
    EXPECT_TRUE(admission_.change(2, kTenFrames).has_value());
}

TEST_F(AdmissionTest, PromisesFollowWhatFramesTake) {
    EXPECT_FALSE(admission_.admit(1, "hall", kTenFrames).has_value());
    admission_.observe(1, 60s);
    admission_.observe(1, 60s);
    EXPECT_DOUBLE_EQ(admission_.promised_ms_per_second("hall"), 300.0) << "its first two frames prepare the device";
    observe(1, 15ms);
    EXPECT_NEAR(admission_.promised_ms_per_second("hall"), 150.0, 0.1);
    EXPECT_FALSE(admission_.admit(2, "hall", kTenFrames).has_value());
    EXPECT_NEAR(admission_.promised_ms_per_second("hall"), 300.0, 0.1) << "so the next one is expected to be as cheap";
    admission_.observe(77, 1s); // the last frame of one that has gone
}

/// Threads and descriptors of this process.
struct Holdings {
    static Holdings now() {
        Holdings holdings;
        std::ifstream status("/proc/self/status");
        for (std::string word; status >> word;) {
            if (word == "Threads:") {
                status >> holdings.threads;
            }
        }
        const std::filesystem::directory_iterator descriptors("/proc/self/fd");
        holdings.descriptors = static_cast<int>(std::distance(begin(descriptors), end(descriptors)));
        return holdings;
    }
    int threads = 0;
    int descriptors = 0;
};

class OwnCamerasTest : public testing::Test {
protected:
    feed::OwnFeed open() {
        auto own = channel_->opener()->open({.frames_per_second = 1.0F});
        EXPECT_TRUE(own.has_value()) << own.error();
        return own ? std::move(*own) : feed::OwnFeed();
    }

    std::string page() { return registry_.page().text(); }

    metrics::Registry registry_;
    CameraFactory factory_;
    OwnCameras cameras_{{.max_cameras = 3, .max_ms_per_second = 1000.0}, registry_};
    std::shared_ptr<feed::Feed> channel_ = test::own_channel(cameras_, factory_);
};

TEST_F(OwnCamerasTest, EveryFeedHasACameraOfItsOwnUntilItCloses) {
    feed::OwnFeed first = open();
    feed::OwnFeed second = open();
    ASSERT_TRUE(factory_.wait_until_living(2));
    EXPECT_NE(first.feed(), second.feed());
    EXPECT_NE(first.feed()->steering(), second.feed()->steering());
    EXPECT_EQ(channel_->steering(), nullptr) << "nobody steers the channel itself";
    const auto feed = first.feed();
    first.close();
    ASSERT_TRUE(factory_.wait_until_living(1));
    EXPECT_FALSE(factory_.has(feed));
    EXPECT_TRUE(factory_.has(second.feed()));
}

TEST_F(OwnCamerasTest, ACameraCountsUntilItIsGone) {
    factory_.shut();
    feed::OwnFeed first = open();
    ASSERT_TRUE(factory_.wait_until_begun(1));
    feed::OwnFeed second = open();
    feed::OwnFeed third = open();
    EXPECT_FALSE(channel_->opener()->open({.frames_per_second = 1.0F}).has_value());
    first.close(); // it is being made: it cannot go yet
    EXPECT_FALSE(channel_->opener()->open({.frames_per_second = 1.0F}).has_value());
    second.close(); // it has not begun
    feed::OwnFeed fourth = open();
    EXPECT_EQ(factory_.begun(), 1);
    EXPECT_THAT(page(), HasSubstr("fieldcast_own_cameras{channel=\"own\"} 3"));
    EXPECT_THAT(page(), HasSubstr("fieldcast_own_cameras_refused_total{channel=\"own\",reason=\"cameras\"} 2"));
    factory_.open();
    ASSERT_TRUE(factory_.wait_until_begun(3));
    EXPECT_TRUE(factory_.wait_until_living(2));
    EXPECT_EQ(factory_.begun(), 3) << "the second one was never made";
}

TEST_F(OwnCamerasTest, ChurnLeavesNothingBehind) {
    {
        const feed::OwnFeed warm_up = open();
        ASSERT_TRUE(factory_.wait_until_living(1));
    }
    ASSERT_TRUE(factory_.wait_until_living(0));
    const Holdings before = Holdings::now();
    constexpr int kOpens = 400;
    int refused = 0;
    for (int i = 0; i < kOpens; ++i) {
        auto own = channel_->opener()->open({.frames_per_second = 1.0F});
        refused += own ? 0 : 1;
        if (own && i % 7 == 0) { // this one gets as far as frames
            Guarded<bool> has_frame;
            std::condition_variable came;
            feed::ViewSelection selection;
            selection.format.width_px = selection.format.height_px = 4;
            auto subscription = feed::Feed::subscribe(own->feed(), selection, [&](const feed::FramePtr&) {
                *has_frame.lock() = true;
                came.notify_all();
            });
            ASSERT_TRUE(subscription.has_value());
            EXPECT_TRUE(has_frame.lock().wait_until(came, std::chrono::steady_clock::now() + CameraFactory::kPatience,
                                                    [](bool has) { return has; }));
            subscription->end();
            own->close();
            EXPECT_TRUE(factory_.wait_until_living(0)); // the last callback has returned
        }
    }
    EXPECT_LT(refused, kOpens) << "only while others were being ended";
    ASSERT_TRUE(factory_.wait_until_living(0));
    EXPECT_TRUE(test::comes_true([&] { return Holdings::now().threads <= before.threads; }, CameraFactory::kPatience))
        << "a joined thread leaves the list of the kernel a moment later, but not these: " << Holdings::now().threads;
    EXPECT_LE(Holdings::now().descriptors, before.descriptors);
    EXPECT_EQ(factory_.threads().size(), 1U) << "made and ended by one thread";
    EXPECT_FALSE(factory_.threads().contains(std::this_thread::get_id())) << "which is not ours";
}

TEST_F(OwnCamerasTest, ACameraThatCannotBeMadeFailsAlone) {
    feed::OwnFeed good = open();
    ASSERT_TRUE(factory_.wait_until_living(1));
    factory_.fail_from_now_on();
    feed::OwnFeed bad = open();
    EXPECT_TRUE(test::comes_true([&] { return bad.feed()->has_failed(); }, CameraFactory::kPatience));
    EXPECT_FALSE(good.feed()->has_failed());
    EXPECT_FALSE(channel_->has_failed());
}

TEST_F(OwnCamerasTest, TheChannelWaitsAsLongAsItsSlowestCamera) {
    factory_.shut();
    feed::OwnFeed own = open();
    const auto now = std::chrono::steady_clock::now();
    EXPECT_EQ(channel_->waiting_time(now + 5s), 0ns) << "nobody has subscribed";
    const auto subscription = feed::Feed::subscribe(own.feed(), feed::PlaneSelection{}, [](const feed::FramePtr&) {});
    EXPECT_GE(channel_->waiting_time(now + 5s), 4s);
    factory_.open();
}

TEST_F(OwnCamerasTest, WhatFramesCostDecidesAboutTheNext) {
    feed::OwnFeed first = open();
    feed::OwnFeed second = open();
    ASSERT_TRUE(factory_.wait_until_living(2));
    for (int i = 0; i < 60; ++i) {
        factory_.tell_cost(480ms); // of a second each
    }
    const auto third = channel_->opener()->open({.frames_per_second = 1.0F});
    ASSERT_FALSE(third.has_value());
    EXPECT_THAT(third.error(), HasSubstr("channel 'own'"));
    EXPECT_THAT(third.error(), HasSubstr("of 1000 are left"));
    EXPECT_THAT(page(), HasSubstr("fieldcast_own_cameras_refused_total{channel=\"own\",reason=\"device_time\"} 1"));
    EXPECT_THAT(page(), HasSubstr("fieldcast_own_camera_promised_ratio{channel=\"own\"} 0.9"));
}

} // namespace
} // namespace fieldcast::camera
