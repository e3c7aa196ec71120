// SPDX-License-Identifier: Apache-2.0
// What a client accepts of a server that grants and changes streams, and what it does not.
#include "tests/client/client_session.h"

#include "core/wire/convert.h"

#include <gmock/gmock.h>

namespace fieldcast::test {
namespace {

using namespace client::net;
using testing::HasSubstr;

TEST_F(SessionTest, ReportsARefusalWithItsField) {
    open([](FakeCall& call, int) {
        call.read_until(v1::ClientMessage::kConfigure);
        v1::ServerMessage message;
        message.mutable_refused()->set_request_id(1);
        message.mutable_refused()->set_field("grid.rows");
        message.mutable_refused()->set_message("9, at most\n6");
        call.send(message);
        call.read_rest();
    });
    const auto refused = next<Refused>();
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->message, "grid.rows: 9, at most 6"); // control characters do not reach the terminal
    EXPECT_FALSE(refused->is_transient);
}

TEST_F(SessionTest, EndsWhenAFrameComesBeforeConfigured) {
    open([](FakeCall& call, int) {
        const auto configure = call.read_until(v1::ClientMessage::kConfigure);
        v1::ServerMessage chunk;
        chunk.mutable_frame_chunk()->set_frame_id(1);
        call.send(chunk);
        call.read_rest();
    });
    const auto ended = next<Ended>();
    ASSERT_TRUE(ended);
    EXPECT_THAT(ended->error.what(), HasSubstr("before Configured"));
    EXPECT_FALSE(ended->error.is_transient());
}

TEST_F(SessionTest, EndsWhenAnotherGridIsGranted) {
    open([](FakeCall& call, int) {
        auto configure = call.read_until(v1::ClientMessage::kConfigure);
        configure->mutable_configure()->mutable_grid()->set_cols(3);
        call.send(configured_message(configure->configure()));
        call.read_rest();
    });
    const auto ended = next<Ended>();
    ASSERT_TRUE(ended);
    EXPECT_THAT(ended->error.what(), HasSubstr("another grid"));
}

TEST_F(SessionTest, EndsWhenALossyCodecIsGrantedThatWasNotAskedFor) {
    open([](FakeCall& call, int) {
        const auto configure = call.read_until(v1::ClientMessage::kConfigure);
        ASSERT_EQ(configure->configure().codecs_size(), 1); // of views, whose only plane is COLOUR
        v1::ServerMessage message = configured_message(configure->configure());
        v1::PlaneHeader& plane = *message.mutable_configured()->add_planes();
        plane.set_semantic(v1::PLANE_SEMANTIC_COLOUR);
        plane.set_codec(v1::CODEC_JPEG);
        call.send(message);
        call.read_rest();
    });
    const auto ended = next<Ended>();
    ASSERT_TRUE(ended);
    EXPECT_THAT(ended->error.what(), HasSubstr("codec that was not asked for"));
}

TEST_F(SessionTest, EndsWhenGrantedFramesAreTooLarge) {
    Request request = small_request();
    request.rows = 8;
    request.cols = 9;
    open(
        [](FakeCall& call, int) {
            auto configure = call.read_until(v1::ClientMessage::kConfigure);
            configure->mutable_configure()->set_view_width_px(8000);
            configure->mutable_configure()->set_view_height_px(8000);
            call.send(configured_message(configure->configure()));
            call.read_rest();
        },
        request);
    const auto ended = next<Ended>();
    ASSERT_TRUE(ended);
    EXPECT_THAT(ended->error.what(), HasSubstr("at most 1024 MiB"));
}

TEST_F(SessionTest, AsksForSomethingElseOnTheRunningStream) {
    open([](FakeCall& call, int) {
        const wire::ViewSet before = call.grant();
        call.send(views_messages(before, 1));
        const auto asked = call.read_until(v1::ClientMessage::kConfigure);
        call.send(views_messages(before, 2)); // still of the old epoch
        call.send(configured_message(asked->configure()));
        call.send(
            views_messages(*wire::from_proto(configured_message(asked->configure()).configured().view_set()), 3, 2));
        call.read_rest();
    });
    ASSERT_TRUE(next<FrameArrived>());
    Request wider = small_request();
    wider.cols = 5;
    session_->configure(wider);
    const auto old = next<FrameArrived>();
    ASSERT_TRUE(old);
    EXPECT_EQ(std::get<wire::ReceivedViews>(old->frame.content).views.views.size(), 2U);
    const auto agreement = next<Agreement>();
    ASSERT_TRUE(agreement);
    EXPECT_EQ(agreement->epoch, 2U);
    EXPECT_EQ(agreement->view_set.grid.cols, 5U);
    const auto changed = next<FrameArrived>();
    ASSERT_TRUE(changed);
    EXPECT_EQ(changed->frame.epoch, 2U);
    EXPECT_EQ(std::get<wire::ReceivedViews>(changed->frame.content).views.views.size(), 5U);
    EXPECT_EQ(server_->call_count(), 1) << "no new connection";
}

TEST_F(SessionTest, ARefusedChangeLeavesTheAgreementAsItWas) {
    open([](FakeCall& call, int) {
        const wire::ViewSet before = call.grant();
        const auto asked = call.read_until(v1::ClientMessage::kConfigure);
        v1::ServerMessage no;
        no.mutable_refused()->set_request_id(asked->configure().request_id());
        no.mutable_refused()->set_reason(v1::REFUSAL_REASON_EXHAUSTED);
        call.send(no);
        call.send(views_messages(before, 7));
        call.read_rest();
    });
    ASSERT_TRUE(next<Agreement>());
    Request wider = small_request();
    wider.cols = 5;
    session_->configure(wider);
    const auto refused = next<Refused>();
    ASSERT_TRUE(refused);
    EXPECT_TRUE(refused->was_change);
    EXPECT_TRUE(refused->is_transient);
    const auto arrived = next<FrameArrived>();
    ASSERT_TRUE(arrived);
    EXPECT_EQ(arrived->frame_id, 7U);
}

TEST_F(SessionTest, AnEpochThatNobodyAskedForEndsTheStream) {
    open([](FakeCall& call, int) {
        const auto asked = call.read_until(v1::ClientMessage::kConfigure);
        call.send(configured_message(asked->configure()));
        v1::ServerMessage another = configured_message(asked->configure());
        another.mutable_configured()->set_epoch(2);
        call.send(another);
        call.read_rest();
    });
    const auto ended = next<Ended>();
    ASSERT_TRUE(ended);
    EXPECT_THAT(ended->error.what(), HasSubstr("without a matching request"));
}

/// A server that grants two columns, then changes to `cols` by itself.
FakeServer::Script adapting_to(std::uint32_t cols) {
    return [cols](FakeCall& call, int) {
        const auto asked = call.read_until(v1::ClientMessage::kConfigure);
        call.send(configured_message(asked->configure()));
        v1::ServerMessage changed = configured_message(asked->configure());
        changed.mutable_configured()->set_epoch(2);
        changed.mutable_configured()->mutable_view_set()->mutable_grid()->set_cols(cols);
        changed.mutable_configured()->mutable_adapted()->set_level(1);
        changed.mutable_configured()->mutable_adapted()->set_change("fewer\nviews");
        call.send(changed);
        call.send(views_messages(*wire::from_proto(changed.configured().view_set()), 3, 2));
        call.read_rest();
    };
}

TEST_F(SessionTest, FollowsAServerThatAdapts) {
    Request request = small_request();
    request.adaptation = AdaptationBounds{.min_rows = 1, .min_cols = 1};
    open(adapting_to(1), request);
    ASSERT_TRUE(next<Agreement>());
    const auto adapted = next<Agreement>();
    ASSERT_TRUE(adapted);
    ASSERT_TRUE(adapted->adapted);
    EXPECT_EQ(adapted->adapted->level, 1U);
    EXPECT_EQ(adapted->adapted->change, "fewer views") << "without control characters";
    EXPECT_EQ(adapted->view_set.grid.cols, 1U);
    const auto arrived = next<FrameArrived>();
    ASSERT_TRUE(arrived);
    EXPECT_EQ(std::get<wire::ReceivedViews>(arrived->frame.content).views.views.size(), 1U);
}

TEST_F(SessionTest, EndsWhenAServerAdaptsUnasked) {
    open(adapting_to(1));
    const auto ended = next<Ended>();
    ASSERT_TRUE(ended);
    EXPECT_THAT(ended->error.what(), HasSubstr("adapted"));
}

TEST_F(SessionTest, EndsWhenAServerAdaptsBeyondTheBounds) {
    Request request = small_request();
    request.adaptation = AdaptationBounds{.min_rows = 1, .min_cols = 1};
    open(adapting_to(3), request); // more than was asked for
    const auto ended = next<Ended>();
    ASSERT_TRUE(ended);
    EXPECT_THAT(ended->error.what(), HasSubstr("another grid"));
}

/// A frame of illumination with two layers, 64 pixels wide.
wire::ReceivedFrame light_frame(std::uint32_t height_px) {
    SourceFrame source;
    source.header.source = make_camera(glm::mat4(1.0F), 0.8F, 64, 36);
    source.header.layer_count = kMaxLayers;
    for (const PlaneSemantic semantic : {PlaneSemantic::kDiffuse, PlaneSemantic::kSpecular}) {
        source.planes.push_back({semantic, PlaneFormat::kR11G11B10F, 64, height_px, {}});
    }
    wire::ReceivedFrame frame;
    frame.content = std::move(source);
    return frame;
}

TEST(FrameProblem, PlanesAreThoseThatWereAnnounced) {
    Request request = small_request();
    request.mode = DeliveryMode::kScene;
    v1::Configured configured = configured_message(to_configure(request, 1)).configured();
    for (const v1::PlaneSemantic semantic : {v1::PLANE_SEMANTIC_DIFFUSE, v1::PLANE_SEMANTIC_SPECULAR}) {
        v1::PlaneHeader& plane = *configured.add_planes();
        plane.set_semantic(semantic);
        plane.set_format(v1::PLANE_FORMAT_R11G11B10F);
        plane.set_codec(v1::CODEC_ZSTD_FILTERED);
        plane.set_width_px(64);
        plane.set_height_px(108);
    }
    const auto agreement = from_configured(configured, request);
    ASSERT_TRUE(agreement) << agreement.error().message;
    EXPECT_EQ(agreement->limits.max_frame_bytes, 2U * 4U * 64U * 108U) << "what was announced, and no more";
    EXPECT_EQ(frame_problem(light_frame(108), *agreement), std::nullopt);
    EXPECT_THAT(frame_problem(light_frame(109), *agreement).value_or(""), HasSubstr("larger planes"));
    configured.mutable_planes()->SwapElements(0, 1);
    EXPECT_THAT(frame_problem(light_frame(108), *from_configured(configured, request)).value_or(""), HasSubstr("other"));
}

} // namespace
} // namespace fieldcast::test
