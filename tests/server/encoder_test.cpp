// SPDX-License-Identifier: Apache-2.0
#include "server/channel/channel_metrics.h"
#include "server/channel/frame_encoder.h"

#include <gtest/gtest.h>

namespace fieldcast::channel {
namespace {

using namespace std::chrono_literals;

class Encoder : public testing::Test {
protected:
    /// The same planes and views every time, so that what may refer to a key frame repeats it.
    RenderedFrame still_frame() {
        RenderedFrame frame;
        frame.header.frame_id = ++frame_id_;
        frame.choices = {{.semantic = PlaneSemantic::kDepth, .encoding = {}}};
        frame.source = SourceFrame{frame.header, {plane(PlaneSemantic::kDepth, PlaneFormat::kF32)}};
        frame.views.push_back({.formats = {format_}, .views = {.header = frame.header, .views = {}}});
        for (const LatticePosition position : lattice_positions(grid_)) {
            frame.views[0].views.views.push_back(
                {.position = position, .image = plane(PlaneSemantic::kColour, PlaneFormat::kRgb8), .discards = {}});
        }
        return frame;
    }

    static Plane plane(PlaneSemantic semantic, PlaneFormat format) {
        Plane plane{.semantic = semantic, .format = format, .width_px = 16, .height_px = 8, .bytes = {}};
        for (std::size_t i = 0; i < plane_bytes(format, 16, 8); ++i) {
            plane.bytes.push_back(static_cast<std::byte>(i * 97));
        }
        return plane;
    }

    /// Key frame that the next frame refers to, `later` after the one before.
    feed::FramePtr encode(KeyFrames::TimePoint::duration later, RenderedFrame frame) {
        now_ += later;
        return encoder_.encode(std::move(frame), now_);
    }

    static bool repeats(const wire::EncodedPlane& plane) {
        return plane.encoded_bytes() == codec::kStripHeaderBytes * plane.strips.size();
    }

    const ViewGrid grid_{.rows = 1, .cols = 2, .geometry = {}, .anchor = Anchor::kLattice};
    wire::ViewFormat format_{.geometry = {}, .width_px = 16, .height_px = 8};
    std::uint64_t frame_id_ = 0;
    KeyFrames::TimePoint now_{1h};
    FrameEncoder encoder_;
};

TEST_F(Encoder, LaterFramesReferToTheKeyFrame) {
    const auto first = encode(0ms, still_frame());
    EXPECT_EQ(first->key_frame_id, 1U);
    EXPECT_FALSE(repeats(first->source->planes[0]));
    const auto second = encode(100ms, still_frame());
    EXPECT_EQ(second->key_frame_id, 1U);
    EXPECT_EQ(second->source->key_frame_id, 1U);
    EXPECT_EQ(second->views[0].key_frame_id, 1U);
    EXPECT_TRUE(repeats(second->source->planes[0]));
    for (const auto& [position, view] : second->views[0].views) {
        EXPECT_TRUE(repeats(view.image));
        EXPECT_FALSE(view.image.stands_alone());
    }
}

TEST_F(Encoder, StripsStandAloneIfSomebodyLacksTheKeyFrame) {
    encode(0ms, still_frame());
    RenderedFrame frame = still_frame();
    frame.needs_alone = true;
    const auto encoded = encode(100ms, std::move(frame));
    EXPECT_TRUE(repeats(encoded->source->planes[0]));
    EXPECT_TRUE(encoded->source->planes[0].stands_alone());
    EXPECT_TRUE(encoded->views[0].views.begin()->second.image.stands_alone());
}

TEST_F(Encoder, AKeyFrameComesAtLeastEverySecond) {
    encode(0ms, still_frame());
    EXPECT_EQ(encode(999ms, still_frame())->key_frame_id, 1U);
    EXPECT_EQ(encode(1ms, still_frame())->key_frame_id, 3U);
    EXPECT_EQ(encode(5s, still_frame())->key_frame_id, 4U);
}

TEST_F(Encoder, KeyFramesAreForcedAtMostTwiceASecond) {
    const auto wanted = [this] {
        RenderedFrame frame = still_frame();
        frame.needs_key = true;
        return frame;
    };
    encode(0ms, still_frame());
    EXPECT_EQ(encode(499ms, wanted())->key_frame_id, 1U);
    EXPECT_EQ(encode(1ms, wanted())->key_frame_id, 3U);
    EXPECT_EQ(encode(100ms, wanted())->key_frame_id, 3U);
    RenderedFrame cut = still_frame();
    cut.header.cut = true;
    EXPECT_EQ(encode(400ms, std::move(cut))->key_frame_id, 5U);
}

TEST_F(Encoder, WhatTheKeyFrameLacksRefersToNothing) {
    encode(0ms, still_frame());
    format_.fovy_rad = 0.5F; // other views of the same size
    const auto encoded = encode(100ms, still_frame());
    EXPECT_TRUE(repeats(encoded->source->planes[0]));
    for (const auto& [position, view] : encoded->views[0].views) {
        EXPECT_FALSE(repeats(view.image));
        EXPECT_TRUE(view.image.stands_alone());
    }
}

TEST_F(Encoder, NestedGridsAreRenderedAndEncodedOnce) {
    feed::Demand demand;
    for (const std::uint32_t side : {3U, 6U}) {
        const ViewGrid grid{.rows = side, .cols = side, .geometry = {}, .anchor = Anchor::kLattice};
        add(demand, feed::ViewSelection{.format = format_, .grid = grid});
    }
    RenderedFrame frame;
    frame.header.frame_id = 1;
    frame.asked_views = demand.asked_views;
    frame.views.push_back({.formats = {format_}, .views = {.header = frame.header, .views = {}}});
    for (const LatticePosition position : demand.views.at(0).positions) {
        frame.views[0].views.views.push_back(
            {.position = position, .image = plane(PlaneSemantic::kColour, PlaneFormat::kRgb8), .discards = {}});
    }
    metrics::Registry registry;
    ChannelMetrics metrics(registry, "hall");
    metrics.count_rendered(frame, 0);
    const auto encoded = encode(0ms, std::move(frame));
    metrics.count_encoded(*encoded, 1ms);
    const std::string page = registry.page().text();
    for (const auto& [step, count] : {std::pair("asked", 45), std::pair("rendered", 36), std::pair("encoded", 36)}) {
        const std::string line = "fieldcast_views_total{channel=\"hall\",step=\"" + std::string(step) + "\"} " +
                                 std::to_string(count) + "\n";
        EXPECT_NE(page.find(line), std::string::npos) << line << page;
    }
    for (const std::uint32_t side : {3U, 6U}) {
        const ViewGrid grid{.rows = side, .cols = side, .geometry = {}, .anchor = Anchor::kLattice};
        EXPECT_TRUE(feed::covers(*encoded, feed::ViewSelection{.format = format_, .grid = grid})) << side;
    }
}

} // namespace
} // namespace fieldcast::channel
