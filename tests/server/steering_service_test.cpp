// SPDX-License-Identifier: Apache-2.0
// Clients that steer one camera, over gRPC: refused, waiting, handing over, taking, falling silent, leaving.
#include "server/service/grpc_server.h"
#include "tests/fixtures/test_folder.h"
#include "tests/server/server_client.h"
#include "tests/server/synthetic.h"

#include <gmock/gmock.h>

namespace fieldcast::test {
namespace {

using namespace std::chrono_literals;
using Kind = v1::ServerMessage;

feed::ChannelInfo steered_info(std::chrono::milliseconds lease) {
    feed::ChannelInfo info = synthetic_info();
    info.control = feed::CameraControl::kSteered;
    info.steering_lease = lease;
    return info;
}

/// A server with tokens, as roles only differ there.
class SteeringService : public testing::Test {
protected:
    /// Nobody's lease ends by itself.
    explicit SteeringService(std::chrono::milliseconds lease = 10min) : channel_(steered_info(lease)) {
        std::string lines;
        for (const auto& [name, role] :
             {std::pair("vera", access::Role::kView), std::pair("ann", access::Role::kSteer),
              std::pair("bob", access::Role::kSteer), std::pair("olga", access::Role::kAdmin)}) {
            lines +=
                access::token_line({.name = name, .role = role, .hash = access::hash_token(token_of(name))}) + "\n";
        }
        write_file(folder_ / "tokens.txt", lines);
        server_ = std::make_unique<service::GrpcServer>(
            HostPort{.host = "127.0.0.1", .port = 0}, std::vector{channel_.feed()}, session::Limits{},
            access::Security{.certificates = std::nullopt, .tokens = folder_ / "tokens.txt"});
    }

    static std::string token_of(const std::string& name) { return name + "-of-the-steering-service-test-1234567890"; }

    std::unique_ptr<OpenCall> open(const std::string& name) {
        auto call = std::make_unique<OpenCall>(connect(server_->port()), token_of(name));
        call->configure();
        EXPECT_TRUE(call->read_until(Kind::kConfigured).has_value()) << name;
        return call;
    }

    static void request(OpenCall& call, bool waits = false, bool takes = false) {
        v1::ClientMessage message;
        message.mutable_request_steering()->set_waits(waits);
        message.mutable_request_steering()->set_takes(takes);
        call.send(message);
    }

    static void keep_alive(OpenCall& call) {
        v1::ClientMessage message;
        message.mutable_steer_camera();
        call.send(message);
    }

    static v1::SteeringDenied denied(OpenCall& call) {
        const auto message = call.read_until(Kind::kSteeringDenied);
        EXPECT_TRUE(message.has_value());
        return message.value_or(Kind{}).steering_denied();
    }

    static v1::SteeringReleased released(OpenCall& call) {
        const auto message = call.read_until(Kind::kSteeringReleased);
        EXPECT_TRUE(message.has_value());
        return message.value_or(Kind{}).steering_released();
    }

    static std::uint64_t granted(OpenCall& call) {
        const auto message = call.read_until(Kind::kSteeringGranted);
        EXPECT_TRUE(message.has_value());
        return message.value_or(Kind{}).steering_granted().lease();
    }

    TestFolder folder_;
    SyntheticChannel channel_;
    std::unique_ptr<service::GrpcServer> server_;
};

class ShortSteeringService : public SteeringService {
protected:
    ShortSteeringService() : SteeringService(5s) {} // longer than a few calls on a busy machine, short enough to wait for
};

TEST_F(SteeringService, TheCatalogueSaysThatTheCameraIsSteered) {
    grpc::ClientContext context;
    context.AddMetadata("authorization", "Bearer " + token_of("vera"));
    v1::ListChannelsResponse response;
    ASSERT_TRUE(v1::Catalog::NewStub(connect(server_->port()))->ListChannels(&context, {}, &response).ok());
    EXPECT_EQ(response.channels(0).cameras(0).control(), v1::CAMERA_CONTROL_STEERED);
}

TEST_F(SteeringService, WhoMayOnlyViewDoesNotSteer) {
    const auto vera = open("vera");
    request(*vera);
    EXPECT_EQ(denied(*vera).reason(), v1::STEERING_DENIAL_REASON_ROLE_TOO_LOW);
    const auto ann = open("ann");
    request(*ann, false, true);
    EXPECT_EQ(denied(*ann).reason(), v1::STEERING_DENIAL_REASON_ROLE_TOO_LOW) << "taking needs admin";
    request(*ann);
    EXPECT_EQ(granted(*ann), 1U);
}

TEST_F(ShortSteeringService, AnExpiredLeaseGoesToWhoWaits) {
    const auto ann = open("ann");
    const auto bob = open("bob");
    request(*ann);
    EXPECT_EQ(granted(*ann), 1U);
    request(*bob, true);
    const v1::SteeringDenied waiting = denied(*bob);
    EXPECT_EQ(waiting.reason(), v1::STEERING_DENIAL_REASON_HELD);
    EXPECT_EQ(waiting.holder(), "ann");
    EXPECT_TRUE(waiting.waits());
    EXPECT_EQ(granted(*bob), 2U) << "ann fell silent";
    EXPECT_EQ(released(*ann).reason(), v1::STEERING_RELEASE_REASON_EXPIRED);
}

TEST_F(SteeringService, AnOfferHandsTheCameraOver) {
    const auto ann = open("ann");
    const auto bob = open("bob");
    request(*ann);
    EXPECT_EQ(granted(*ann), 1U);
    request(*bob, true);
    EXPECT_TRUE(denied(*bob).waits());
    v1::ClientMessage offer;
    offer.mutable_offer_steering();
    keep_alive(*ann);
    ann->send(offer);
    EXPECT_EQ(released(*ann).reason(), v1::STEERING_RELEASE_REASON_HANDED_OVER);
    EXPECT_EQ(granted(*bob), 2U);
}

TEST_F(SteeringService, AdminsTakeTheCamera) {
    const auto ann = open("ann");
    const auto olga = open("olga");
    request(*ann);
    EXPECT_EQ(granted(*ann), 1U);
    keep_alive(*ann);
    request(*olga, false, true);
    EXPECT_EQ(granted(*olga), 2U);
    EXPECT_EQ(released(*ann).reason(), v1::STEERING_RELEASE_REASON_TAKEN);
}

TEST_F(SteeringService, AStreamThatEndsLetsGo) {
    auto ann = open("ann");
    const auto bob = open("bob");
    request(*ann);
    EXPECT_EQ(granted(*ann), 1U);
    keep_alive(*ann);
    ann->cancel();
    ann->finish();
    request(*bob, true);
    EXPECT_EQ(granted(*bob), 2U);
}

} // namespace
} // namespace fieldcast::test
