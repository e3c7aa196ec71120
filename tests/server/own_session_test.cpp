// SPDX-License-Identifier: Apache-2.0
// Sessions on a channel that gives each of them a camera.
#include "server/session/server_session.h"
#include "tests/fixtures/polling.h"
#include "tests/server/camera_factory.h"

#include <gmock/gmock.h>

namespace fieldcast::session {
namespace {

using namespace std::chrono_literals;
using Kind = v1::ServerMessage;
using test::CameraFactory;
using testing::HasSubstr;

const feed::Steerer kAnn{.name = "ann", .right = feed::SteeringRight::kSteer};

class OwnSession : public testing::Test {
protected:
    std::unique_ptr<ServerSession> open(const feed::Steerer& steerer = kAnn) {
        return std::make_unique<ServerSession>(
            std::vector{own_, other_, fixed_}, Limits{}, [](const feed::FramePtr&) {}, now_,
            PeerBudgets{.cameras = peer_cameras_}, steerer);
    }

    /// The next message that is no heartbeat, or one of no kind.
    v1::ServerMessage next(ServerSession& session) {
        v1::ServerMessage message;
        while (const auto chunk = session.next(now_)) {
            EXPECT_TRUE(message.ParseFromString(wire::joined(*chunk)));
            if (message.message_case() != Kind::kHeartbeat) {
                return message;
            }
        }
        return {};
    }

    v1::ServerMessage configure(ServerSession& session, const std::string& channel, float fps = 1.0F,
                                std::uint32_t side = 1) {
        v1::ClientMessage message;
        v1::Configure& wanted = *message.mutable_configure();
        wanted.set_channel(channel);
        wanted.set_max_frames_per_second(fps);
        wanted.mutable_grid()->set_rows(side);
        wanted.mutable_grid()->set_cols(side);
        session.on_message(message, now_);
        return next(session);
    }

    void steer(ServerSession& session, float x_m) {
        v1::ClientMessage message;
        v1::SteerCamera& steer = *message.mutable_steer_camera();
        for (const float value : {1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, x_m, 0.0F, 0.0F}) {
            steer.add_world_from_camera(value);
        }
        steer.set_sequence(1);
        session.on_message(message, now_);
    }

    void request(ServerSession& session) {
        v1::ClientMessage message;
        message.mutable_request_steering();
        session.on_message(message, now_);
        EXPECT_EQ(next(session).steering_granted().lease(), 1U);
    }

    static const std::shared_ptr<feed::Feed>& feed_of(const ServerSession& session) {
        return session.configuration()->feed;
    }

    TimePoint now_ = std::chrono::steady_clock::now(); // as for who leaves a camera
    std::shared_ptr<Budget> peer_cameras_; ///< null: no limit
    metrics::Registry registry_;
    CameraFactory factory_;
    camera::OwnCameras cameras_{{.max_cameras = 2, .max_ms_per_second = 100.0}, registry_};
    std::shared_ptr<feed::Feed> own_ = test::own_channel(cameras_, factory_);
    std::shared_ptr<feed::Feed> other_ = test::own_channel(cameras_, factory_, "other");
    std::shared_ptr<feed::Feed> fixed_ = std::make_shared<feed::Feed>(test::synthetic_info("fixed"));
};

TEST_F(OwnSession, EverybodySteersSomethingElse) {
    const auto ann = open();
    const auto bob = open();
    const v1::ServerMessage configured = configure(*ann, "own");
    EXPECT_EQ(configured.configured().channel(), "own");
    EXPECT_EQ(configure(*bob, "own").message_case(), Kind::kConfigured);
    EXPECT_NE(feed_of(*ann), feed_of(*bob));
    request(*ann);
    request(*bob); // both at the same time
    steer(*ann, 3.0F);
    EXPECT_FALSE(feed_of(*bob)->steering()->sample().has_value());
    steer(*bob, 5.0F);
    EXPECT_EQ(feed_of(*ann)->steering()->sample()->world_from_camera[3].x, 3.0F);
    EXPECT_EQ(feed_of(*bob)->steering()->sample()->world_from_camera[3].x, 5.0F);
    EXPECT_TRUE(factory_.wait_until_living(2));
}

TEST_F(OwnSession, NobodyHasToShowASignOfLife) {
    const auto ann = open();
    configure(*ann, "own");
    request(*ann);
    now_ += 2h;
    steer(*ann, 3.0F);
    EXPECT_EQ(next(*ann).message_case(), Kind::MESSAGE_NOT_SET);
    EXPECT_TRUE(feed_of(*ann)->steering()->sample().has_value());
}

TEST_F(OwnSession, AnotherGridKeepsTheCamera) {
    const auto ann = open();
    configure(*ann, "own", 2.0F);
    const auto feed = feed_of(*ann);
    EXPECT_EQ(feed->frames_per_second(), 2.0F);
    request(*ann);
    steer(*ann, 3.0F);
    EXPECT_EQ(configure(*ann, "own", 5.0F, 2).message_case(), Kind::kConfigured);
    EXPECT_EQ(feed_of(*ann), feed);
    EXPECT_EQ(feed->frames_per_second(), 5.0F) << "it renders no more than is wanted";
    // Between a frame that has just begun and the next one that is due, nobody asks for views.
    EXPECT_TRUE(test::comes_true([&] { return feed->demand().view_pixels() == 4U * 64 * 36; }, 20s));
    steer(*ann, 4.0F);
    EXPECT_EQ(next(*ann).message_case(), Kind::MESSAGE_NOT_SET) << "and the lease";
}

TEST_F(OwnSession, WhatDoesNotFitIsRefusedAndNothingChanges) {
    const auto ann = open();
    const auto bob = open();
    configure(*ann, "own", 50.0F); // at about 1 ms a frame: half of what there is
    configure(*bob, "fixed");
    const v1::ServerMessage refused = configure(*bob, "own", 60.0F);
    ASSERT_EQ(refused.message_case(), Kind::kRefused);
    EXPECT_EQ(refused.refused().reason(), v1::REFUSAL_REASON_EXHAUSTED);
    EXPECT_EQ(refused.refused().field(), "channel");
    EXPECT_THAT(refused.refused().message(),
                HasSubstr("61 ms of the device per second asked")); // 2304 pixels: 1.009 ms
    EXPECT_THAT(refused.refused().message(), HasSubstr("50 of 100 are left"));
    EXPECT_EQ(feed_of(*bob), fixed_);
    EXPECT_EQ(fixed_->subscriber_count(), 1U);
    EXPECT_EQ(configure(*bob, "own", 40.0F).message_case(), Kind::kConfigured);
    EXPECT_EQ(fixed_->subscriber_count(), 0U);
    const auto feed = feed_of(*bob);
    EXPECT_EQ(configure(*bob, "own", 60.0F, 6).message_case(), Kind::kRefused);
    EXPECT_EQ(feed->frames_per_second(), 40.0F);
    EXPECT_EQ(feed->demand().view_pixels(), 64U * 36) << "the grid stays too";
    const auto cid = open();
    EXPECT_THAT(configure(*cid, "own").refused().message(), HasSubstr("all 2"));
    EXPECT_FALSE(cid->configuration().has_value());
}

TEST_F(OwnSession, TheCameraGoesWithTheChannelOrTheSession) {
    const auto ann = open();
    const auto bob = open();
    configure(*ann, "own");
    configure(*bob, "own");
    ASSERT_TRUE(factory_.wait_until_living(2));
    EXPECT_EQ(configure(*ann, "fixed").message_case(), Kind::kConfigured);
    EXPECT_TRUE(factory_.wait_until_only({feed_of(*bob)}));
    bob->end();
    ASSERT_TRUE(factory_.wait_until_living(0));
}

TEST_F(OwnSession, FromOneChannelToTheNext) {
    const auto ann = open();
    configure(*ann, "own");
    request(*ann);
    ASSERT_TRUE(factory_.wait_until_living(1));
    const auto before = feed_of(*ann);
    EXPECT_EQ(configure(*ann, "other").configured().channel(), "other");
    EXPECT_EQ(next(*ann).steering_released().reason(), v1::STEERING_RELEASE_REASON_RECONFIGURED);
    EXPECT_NE(feed_of(*ann), before);
    EXPECT_TRUE(factory_.wait_until_only({feed_of(*ann)}));
    request(*ann);
}

TEST_F(OwnSession, FromOneChannelToTheNextWhenEverythingIsTaken) {
    const auto ann = open();
    const auto bob = open();
    configure(*ann, "own", 50.0F); // 50 of 100 ms per second
    configure(*bob, "own", 45.0F);
    ASSERT_TRUE(factory_.wait_until_living(2));
    const auto of_bob = feed_of(*bob);
    EXPECT_EQ(configure(*bob, "other", 60.0F).message_case(), Kind::kRefused) << "more than it gives back";
    EXPECT_EQ(feed_of(*bob), of_bob);
    EXPECT_EQ(configure(*bob, "other", 45.0F).configured().channel(), "other");
    EXPECT_EQ(configure(*ann, "other", 50.0F).configured().channel(), "other");
    EXPECT_TRUE(factory_.wait_until_only({feed_of(*ann), feed_of(*bob)}));
    EXPECT_EQ(factory_.most_living(), 2) << "memory of the device never held three";
}

TEST_F(OwnSession, APeerHasNoMoreThanItsShare) {
    peer_cameras_ = std::make_shared<Budget>(Limits{}.max_own_cameras_per_peer);
    peer_cameras_->take(Limits{}.max_own_cameras_per_peer - 1); // its other sessions
    const auto ann = open();
    const auto bob = open();
    EXPECT_EQ(configure(*ann, "own").message_case(), Kind::kConfigured);
    EXPECT_EQ(configure(*ann, "other").message_case(), Kind::kConfigured) << "one at a time";
    const v1::ServerMessage refused = configure(*bob, "own");
    EXPECT_EQ(refused.refused().reason(), v1::REFUSAL_REASON_EXHAUSTED);
    EXPECT_THAT(refused.refused().message(),
                HasSubstr("one peer may have 1 of all 4, and the last are kept for peers that have none"));
    EXPECT_EQ(configure(*bob, "fixed").message_case(), Kind::kConfigured);
    EXPECT_EQ(configure(*ann, "fixed").message_case(), Kind::kConfigured);
    EXPECT_EQ(configure(*bob, "own").message_case(), Kind::kConfigured) << "ann gave hers back";
    EXPECT_EQ(configure(*bob, "other", 1000.0F).message_case(), Kind::kConfigured) << "whoever is alone";
    EXPECT_EQ(configure(*ann, "own").message_case(), Kind::kRefused);
    bob->end();
    EXPECT_EQ(peer_cameras_->used(), Limits{}.max_own_cameras_per_peer - 1U);
}

TEST_F(OwnSession, WhoIsSentAwayLosesItsCameraAtOnce) {
    const auto ann = open();
    configure(*ann, "own");
    ASSERT_TRUE(factory_.wait_until_living(1));
    ann->go_away("enough", now_);
    EXPECT_EQ(next(*ann).message_case(), Kind::kGoingAway);
    EXPECT_TRUE(factory_.wait_until_living(0));
}

TEST_F(OwnSession, OnlyWhoMaySteerGetsOne) {
    const auto vera = open({.name = "vera", .right = feed::SteeringRight::kNone});
    const v1::ServerMessage refused = configure(*vera, "own");
    EXPECT_EQ(refused.refused().reason(), v1::REFUSAL_REASON_ROLE_TOO_LOW);
    EXPECT_THAT(refused.refused().message(), HasSubstr("role steer"));
    EXPECT_EQ(configure(*vera, "fixed").message_case(), Kind::kConfigured);
    EXPECT_EQ(factory_.begun(), 0);
}

TEST_F(OwnSession, AFailedCameraEndsItsSession) {
    factory_.fail_from_now_on();
    const auto ann = open();
    configure(*ann, "own");
    ASSERT_TRUE(test::comes_true([&] { return feed_of(*ann)->has_failed(); }, CameraFactory::kPatience));
    ann->on_tick(now_);
    const v1::ServerMessage message = next(*ann);
    ASSERT_EQ(message.message_case(), Kind::kGoingAway);
    EXPECT_THAT(message.going_away().reason(), HasSubstr("camera"));
    EXPECT_EQ(ann->close_reason(), CloseReason::kFailed);
}

} // namespace
} // namespace fieldcast::session
