// SPDX-License-Identifier: Apache-2.0
// Who steers a camera: the lease against a clock of its own, and what a session makes of it.
#include "server/session/server_session.h"
#include "tests/server/synthetic.h"

#include <algorithm>
#include <gmock/gmock.h>
#include <limits>

namespace fieldcast::feed {
namespace {

using namespace std::chrono_literals;
using Loss = SteeringLoss;
using Reason = SteeringDenial::Reason;

class SteeringLeaseTest : public testing::Test {
protected:
    SteeringLease::Id join(const std::string& name, SteeringRight right = SteeringRight::kSteer) {
        return lease_.join({.name = name, .right = right});
    }

    template <class Notice> Notice next(SteeringLease::Id id) {
        const auto notice = lease_.next_notice(id);
        if (!notice || !std::holds_alternative<Notice>(*notice)) {
            ADD_FAILURE() << "no such notice for " << id;
            return {};
        }
        return std::get<Notice>(*notice);
    }

    SteeringLease lease_{5s};
    SteeringLease::TimePoint now_{1h};
};

TEST_F(SteeringLeaseTest, OneSteersAtATime) {
    const auto first = join("ann");
    const auto second = join("bob");
    lease_.request(first, SteeringUrgency::kNow, now_);
    EXPECT_EQ(next<SteeringGrant>(first).lease, 1U);
    lease_.request(second, SteeringUrgency::kNow, now_);
    EXPECT_EQ(next<SteeringDenial>(second),
              (SteeringDenial{.reason = Reason::kHeld, .holder = "ann", .is_waiting = false, .ahead = 0}));
    EXPECT_TRUE(lease_.renew(first, now_));
    EXPECT_FALSE(lease_.renew(second, now_));
    lease_.release(first, now_);
    EXPECT_EQ(next<Loss>(first), (Loss{.lease = 1, .reason = Loss::Reason::kReleased}));
    EXPECT_EQ(lease_.next_notice(second), std::nullopt) << "it did not wait";
    lease_.request(second, SteeringUrgency::kNow, now_);
    EXPECT_EQ(next<SteeringGrant>(second).lease, 2U);
}

TEST_F(SteeringLeaseTest, AskingAgainKeepsTheLease) {
    const auto holder = join("ann");
    lease_.request(holder, SteeringUrgency::kNow, now_);
    lease_.request(holder, SteeringUrgency::kWait, now_ + 4s);
    EXPECT_EQ(next<SteeringGrant>(holder).lease, 1U);
    EXPECT_EQ(next<SteeringGrant>(holder).lease, 1U);
    EXPECT_TRUE(lease_.renew(holder, now_ + 8s)) << "it was renewed";
}

TEST_F(SteeringLeaseTest, ExpiresWithoutRenewal) {
    const auto holder = join("ann");
    const auto waiting = join("bob");
    lease_.request(holder, SteeringUrgency::kNow, now_);
    lease_.request(waiting, SteeringUrgency::kWait, now_);
    next<SteeringGrant>(holder);
    EXPECT_TRUE(next<SteeringDenial>(waiting).is_waiting);
    EXPECT_TRUE(lease_.renew(holder, now_ + 4s));
    lease_.look_at_clock(now_ + 8999ms);
    EXPECT_EQ(lease_.next_notice(holder), std::nullopt);
    lease_.look_at_clock(now_ + 9s);
    EXPECT_EQ(next<Loss>(holder), (Loss{.lease = 1, .reason = Loss::Reason::kExpired}));
    EXPECT_EQ(next<SteeringGrant>(waiting).lease, 2U);
    EXPECT_FALSE(lease_.renew(holder, now_ + 9s));
}

TEST_F(SteeringLeaseTest, WaitingIsFirstComeFirstServed) {
    const auto holder = join("ann");
    const auto first = join("bob");
    const auto second = join("cid");
    lease_.request(holder, SteeringUrgency::kNow, now_);
    for (const auto id : {first, second, first}) { // asking twice changes nothing
        lease_.request(id, SteeringUrgency::kWait, now_);
    }
    EXPECT_EQ(next<SteeringDenial>(second).ahead, 1U);
    EXPECT_EQ(next<SteeringDenial>(first).ahead, 0U);
    EXPECT_EQ(next<SteeringDenial>(first).ahead, 0U);
    lease_.leave(holder, now_); // its stream ended
    EXPECT_EQ(next<SteeringGrant>(first).lease, 2U);
    lease_.release(second, now_); // it does not want any more
    lease_.release(first, now_);
    EXPECT_EQ(lease_.lease(), 0U);
    EXPECT_EQ(lease_.next_notice(second), std::nullopt);
}

TEST_F(SteeringLeaseTest, AnOfferGoesToWhoWaitsOrToTheNextWhoAsks) {
    const auto ann = join("ann");
    const auto bob = join("bob");
    lease_.request(ann, SteeringUrgency::kNow, now_);
    lease_.offer(bob, now_);
    lease_.request(bob, SteeringUrgency::kWait, now_);
    EXPECT_EQ(next<SteeringDenial>(bob).reason, Reason::kHeld) << "what one does not hold one cannot offer";
    lease_.offer(ann, now_);
    next<SteeringGrant>(ann);
    EXPECT_EQ(next<Loss>(ann).reason, Loss::Reason::kHandedOver);
    EXPECT_EQ(next<SteeringGrant>(bob).lease, 2U);
    lease_.offer(bob, now_);
    EXPECT_TRUE(lease_.renew(bob, now_)) << "nobody wants it yet";
    lease_.request(ann, SteeringUrgency::kNow, now_);
    EXPECT_EQ(next<SteeringGrant>(ann).lease, 3U);
    EXPECT_EQ(next<Loss>(bob).reason, Loss::Reason::kHandedOver);
    lease_.request(bob, SteeringUrgency::kNow, now_);
    EXPECT_EQ(next<SteeringDenial>(bob).reason, Reason::kHeld) << "an offer is for one";
}

TEST_F(SteeringLeaseTest, RightsDecide) {
    const auto viewer = join("vera", SteeringRight::kNone);
    const auto pilot = join("paul");
    const auto operator_ = join("olga", SteeringRight::kTake);
    lease_.request(viewer, SteeringUrgency::kWait, now_);
    EXPECT_EQ(next<SteeringDenial>(viewer).reason, Reason::kRoleTooLow);
    lease_.request(operator_, SteeringUrgency::kNow, now_);
    lease_.request(pilot, SteeringUrgency::kTake, now_);
    EXPECT_EQ(next<SteeringDenial>(pilot).reason, Reason::kRoleTooLow);
    lease_.release(operator_, now_);
    lease_.request(pilot, SteeringUrgency::kNow, now_);
    next<SteeringGrant>(pilot);
    lease_.request(operator_, SteeringUrgency::kTake, now_);
    EXPECT_EQ(next<Loss>(pilot).reason, Loss::Reason::kTaken);
    EXPECT_TRUE(lease_.renew(operator_, now_));
}

TEST(SteeringTest, NewestPoseWinsAndJumpsAreNotLost) {
    const auto steering = std::make_shared<Steering>(5s);
    const auto now = std::chrono::steady_clock::now(); // as for who leaves
    EXPECT_FALSE(steering->sample().has_value());
    SteeringSeat seat = Steering::join(steering, {.name = "ann", .right = SteeringRight::kSteer});
    EXPECT_FALSE(seat.steer({.sequence = 1}, now)) << "without a lease";
    seat.request(SteeringUrgency::kNow, now);
    EXPECT_TRUE(seat.steer({.sequence = 5, .cut = true}, now));
    EXPECT_TRUE(seat.steer({.sequence = 6, .client_time_ns = 60}, now));
    EXPECT_TRUE(seat.steer({.sequence = 6, .client_time_ns = 61}, now)) << "passed over, but a sign of life";
    const auto first = steering->sample();
    ASSERT_TRUE(first.has_value());
    EXPECT_EQ(first->lease, 1U);
    EXPECT_EQ(first->client_time_ns, 60);
    EXPECT_TRUE(first->cut) << "pose 5 jumped, and no frame has shown that yet";
    EXPECT_FALSE(steering->sample()->cut) << "one frame has";
    seat.leave();
    EXPECT_EQ(steering->sample()->sequence, 6U) << "the camera stays where it is";
}

TEST(SteeringTest, ANewLeaseCountsItsPosesAnew) {
    const auto steering = std::make_shared<Steering>(5s);
    const auto now = std::chrono::steady_clock::now(); // as for who leaves
    SteeringSeat ann = Steering::join(steering, {.name = "ann", .right = SteeringRight::kSteer});
    SteeringSeat bob = Steering::join(steering, {.name = "bob", .right = SteeringRight::kSteer});
    ann.request(SteeringUrgency::kNow, now);
    EXPECT_TRUE(ann.steer({.sequence = 1000}, now));
    ann.leave();
    bob.request(SteeringUrgency::kNow, now);
    EXPECT_TRUE(bob.steer({.sequence = 1}, now));
    EXPECT_EQ(steering->sample()->lease, 2U);
}

} // namespace
} // namespace fieldcast::feed

namespace fieldcast::session {
namespace {

using namespace std::chrono_literals;
using Kind = v1::ServerMessage;

feed::ChannelInfo steered_info() {
    feed::ChannelInfo info = test::synthetic_info();
    info.control = feed::CameraControl::kSteered;
    return info;
}

class SteeringSession : public testing::Test {
protected:
    /// The next message, or one of no kind.
    v1::ServerMessage next() {
        v1::ServerMessage message;
        if (const auto chunk = session_.next(now_)) {
            EXPECT_TRUE(message.ParseFromString(wire::joined(*chunk)));
        }
        return message;
    }

    void configure(const std::string& channel) {
        v1::ClientMessage message;
        message.mutable_configure()->set_channel(channel);
        session_.on_message(message, now_);
        EXPECT_EQ(next().message_case(), Kind::kConfigured);
    }

    void request() {
        v1::ClientMessage message;
        message.mutable_request_steering();
        session_.on_message(message, now_);
    }

    v1::ClientMessage pose(std::uint64_t sequence) {
        v1::ClientMessage message;
        v1::SteerCamera& steer = *message.mutable_steer_camera();
        for (const float value : {1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 4.0F, 5.0F, 6.0F}) {
            steer.add_world_from_camera(value);
        }
        steer.set_sequence(sequence);
        steer.set_client_time_ns(99);
        return message;
    }

    v1::SteeringDenialReason denied() {
        const v1::ServerMessage message = next();
        EXPECT_EQ(message.message_case(), Kind::kSteeringDenied);
        return message.steering_denied().reason();
    }

    TimePoint now_ = std::chrono::steady_clock::now(); // as for who leaves a camera
    std::shared_ptr<feed::Feed> steered_ = std::make_shared<feed::Feed>(steered_info());
    std::shared_ptr<feed::Feed> fixed_ = std::make_shared<feed::Feed>(test::synthetic_info("fixed"));
    ServerSession session_{{steered_, fixed_},
                           Limits{},
                           [](const feed::FramePtr&) {},
                           now_,
                           {},
                           {.name = "ann", .right = feed::SteeringRight::kSteer}};
};

TEST_F(SteeringSession, SteersTheCameraOfItsChannel) {
    configure("synthetic");
    request();
    const v1::ServerMessage granted = next();
    EXPECT_EQ(granted.steering_granted().lease(), 1U);
    EXPECT_EQ(granted.steering_granted().expires_after_ms(), 5000U);
    session_.on_message(pose(7), now_);
    EXPECT_EQ(next().message_case(), Kind::MESSAGE_NOT_SET) << "a good pose needs no answer";
    const auto sampled = steered_->steering()->sample();
    ASSERT_TRUE(sampled.has_value());
    EXPECT_EQ(sampled->sequence, 7U);
    EXPECT_EQ(sampled->client_time_ns, 99);
    EXPECT_EQ(glm::vec3(sampled->world_from_camera[3]), glm::vec3(4.0F, 5.0F, 6.0F));
}

TEST_F(SteeringSession, PosesThatAreNoneAreDenied) {
    configure("synthetic");
    session_.on_message(pose(1), now_);
    EXPECT_EQ(denied(), v1::STEERING_DENIAL_REASON_NOT_HOLDER);
    request();
    next();
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    for (const auto& [index, value] :
         {std::pair(9, kNan), std::pair(0, 1.01F), std::pair(0, -1.0F), std::pair(11, 2e9F)}) {
        v1::ClientMessage bad = pose(2);
        bad.mutable_steer_camera()->set_world_from_camera(index, value);
        session_.on_message(bad, now_);
        EXPECT_EQ(denied(), v1::STEERING_DENIAL_REASON_INVALID_POSE) << index << " = " << value;
    }
    v1::ClientMessage too_short = pose(2);
    too_short.mutable_steer_camera()->mutable_world_from_camera()->RemoveLast();
    session_.on_message(too_short, now_);
    EXPECT_EQ(denied(), v1::STEERING_DENIAL_REASON_INVALID_POSE);
    EXPECT_FALSE(steered_->steering()->sample().has_value());
}

TEST_F(SteeringSession, RoundedRotationsAreMadeExact) {
    configure("synthetic");
    request();
    v1::ClientMessage rounded = pose(1);
    rounded.mutable_steer_camera()->set_world_from_camera(0, 1.0004F); // dot product 1.0008: within 1e-3
    rounded.mutable_steer_camera()->set_world_from_camera(1, 0.0003F);
    session_.on_message(rounded, now_);
    const auto sampled = steered_->steering()->sample();
    ASSERT_TRUE(sampled.has_value());
    const glm::mat3 rotation(sampled->world_from_camera);
    const glm::mat3 product = glm::transpose(rotation) * rotation;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            EXPECT_NEAR(product[i][j], i == j ? 1.0F : 0.0F, 1e-6F); // a few roundings of floats near 1
        }
    }
}

TEST_F(SteeringSession, AskingAllTheTimeFillsNoLog) {
    configure("synthetic");
    testing::internal::CaptureStderr();
    for (int i = 0; i < 20'000; ++i) { // twenty seconds at the highest rate
        request();
        while (next().message_case() != Kind::MESSAGE_NOT_SET) {
        }
        now_ += 1ms;
    }
    const std::string log = testing::internal::GetCapturedStderr();
    EXPECT_FALSE(session_.is_flooded());
    EXPECT_LE(std::count(log.begin(), log.end(), '\n'), 20) << "ten lines of each of two kinds";
    EXPECT_GE(std::count(log.begin(), log.end(), '\n'), 1);
}

TEST_F(SteeringSession, PosesOfThousandsOfValuesAreDenied) {
    configure("synthetic");
    request();
    next();
    v1::ClientMessage huge = pose(2);
    huge.mutable_steer_camera()->mutable_world_from_camera()->Resize(2000, 0.0F);
    session_.on_message(huge, now_);
    const v1::ServerMessage answer = next();
    EXPECT_EQ(answer.steering_denied().reason(), v1::STEERING_DENIAL_REASON_INVALID_POSE);
    EXPECT_THAT(answer.steering_denied().message(), testing::HasSubstr("2000 values, not 12"));
}

TEST_F(SteeringSession, TooManyPosesAreDenied) {
    configure("synthetic");
    request();
    next();
    const auto burst = static_cast<std::uint64_t>(Limits{}.max_poses_per_second);
    for (std::uint64_t i = 1; i <= burst; ++i) {
        session_.on_message(pose(i), now_);
    }
    EXPECT_EQ(next().message_case(), Kind::MESSAGE_NOT_SET);
    session_.on_message(pose(burst + 1), now_);
    EXPECT_EQ(denied(), v1::STEERING_DENIAL_REASON_TOO_FAST);
    EXPECT_EQ(steered_->steering()->sample()->sequence, burst);
    now_ += 10ms; // room for two
    session_.on_message(pose(burst + 2), now_);
    EXPECT_EQ(steered_->steering()->sample()->sequence, burst + 2);
}

TEST_F(SteeringSession, KeepsTheLeaseWithEmptyPosesAndLosesItWithout) {
    configure("synthetic");
    request();
    next();
    v1::ClientMessage alive;
    alive.mutable_steer_camera();
    for (int i = 0; i < 4; ++i) {
        now_ += 4s;
        session_.on_message(alive, now_);
        for (v1::ServerMessage message = next(); message.message_case() != Kind::MESSAGE_NOT_SET; message = next()) {
            EXPECT_EQ(message.message_case(), Kind::kHeartbeat);
        }
    }
    now_ += 5s;
    const v1::ServerMessage released = next();
    EXPECT_EQ(released.steering_released().lease(), 1U);
    EXPECT_EQ(released.steering_released().reason(), v1::STEERING_RELEASE_REASON_EXPIRED);
    session_.on_message(alive, now_);
    EXPECT_EQ(denied(), v1::STEERING_DENIAL_REASON_NOT_HOLDER);
}

TEST_F(SteeringSession, OnlySteeredChannelsAreSteered) {
    request();
    EXPECT_EQ(denied(), v1::STEERING_DENIAL_REASON_NOT_STEERABLE) << "nothing is configured";
    configure("fixed");
    request();
    EXPECT_EQ(denied(), v1::STEERING_DENIAL_REASON_NOT_STEERABLE);
    session_.on_message(pose(1), now_);
    EXPECT_EQ(denied(), v1::STEERING_DENIAL_REASON_NOT_STEERABLE);
}

TEST_F(SteeringSession, LeavingTheChannelLeavesTheCamera) {
    configure("synthetic");
    request();
    next();
    configure("synthetic"); // another grid perhaps; the same camera
    session_.on_message(pose(1), now_);
    EXPECT_EQ(next().message_case(), Kind::MESSAGE_NOT_SET);
    configure("fixed");
    EXPECT_EQ(next().steering_released().reason(), v1::STEERING_RELEASE_REASON_RECONFIGURED);
    feed::SteeringSeat other =
        feed::Steering::join(steered_->steering(), {.name = "bob", .right = feed::SteeringRight::kSteer});
    other.request(feed::SteeringUrgency::kNow, now_);
    EXPECT_TRUE(other.renew(now_));
}

TEST_F(SteeringSession, EndingLetsTheNextOneSteer) {
    configure("synthetic");
    request();
    feed::SteeringSeat other =
        feed::Steering::join(steered_->steering(), {.name = "bob", .right = feed::SteeringRight::kSteer});
    other.request(feed::SteeringUrgency::kWait, now_);
    EXPECT_FALSE(other.renew(now_));
    session_.end();
    EXPECT_TRUE(other.renew(now_));
}

TEST_F(SteeringSession, DenialsThatNobodyReadsStopTheInput) {
    for (std::size_t i = 0; i < kMaxQueuedAnswers; ++i) {
        EXPECT_TRUE(session_.accepts_input());
        request();
    }
    EXPECT_FALSE(session_.accepts_input());
    next();
    EXPECT_TRUE(session_.accepts_input());
}

} // namespace
} // namespace fieldcast::session
