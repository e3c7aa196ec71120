// SPDX-License-Identifier: Apache-2.0
#include "client/play/statistics.h"

#include <gmock/gmock.h>

namespace fieldcast::test {
namespace {

using namespace client::play;
using testing::HasSubstr;

std::vector<ShownFrame> twenty_frames() {
    std::vector<ShownFrame> frames(20);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        frames[i].frame_id = i + 1;
        frames[i].payload_bytes = 1000 * (i % 2);
        frames[i].pose_to_decoded_ms = static_cast<double>(20 - i); // 20 … 1, not sorted
        frames[i].shown_ns = static_cast<std::int64_t>(i) * 100'000'000;
        frames[i].view_pixels = 1000;
        frames[i].id = 30;
        frames[i].normal = 5;
    }
    return frames;
}

TEST(Statistics, SumsUpFrames) {
    const Summary summary = summarise(twenty_frames(), {.sessions = 2, .superseded = 3, .aborted = 0, .failed = 0});
    EXPECT_DOUBLE_EQ(summary.frames_per_second, 10.0);
    EXPECT_DOUBLE_EQ(summary.bytes_per_frame, 500.0);
    EXPECT_DOUBLE_EQ(summary.pose_to_decoded_ms->p50, 10.0);
    EXPECT_DOUBLE_EQ(summary.pose_to_decoded_ms->p95, 19.0);
    EXPECT_FALSE(summary.pose_to_shown_ms);
    EXPECT_DOUBLE_EQ(summary.id_percent, 3.0);
    EXPECT_DOUBLE_EQ(summary.discarded_percent, 3.5);
    EXPECT_THAT(to_table(summary), HasSubstr("3 superseded"));
    EXPECT_THAT(to_json(summary), HasSubstr("\"pose_to_shown_ms\": null"));
}

TEST(Statistics, OfNothingAreZero) {
    const Summary summary = summarise({}, {});
    EXPECT_EQ(summary.frames_per_second, 0.0);
    EXPECT_EQ(summary.discarded_percent, 0.0);
    EXPECT_THAT(to_table(summary), HasSubstr("unknown"));
}

TEST(Statistics, CountsDiscardsOfAllViews) {
    Views views;
    for (int i = 0; i < 2; ++i) {
        View view;
        view.image.width_px = 10;
        view.image.height_px = 5;
        view.discards = {.out_of_frustum = 1, .id = 2, .plane = 3, .normal = 4};
        views.views.push_back(view);
    }
    ShownFrame frame;
    add_discards(views, frame);
    EXPECT_EQ(frame.view_pixels, 100U);
    EXPECT_EQ(frame.plane, 6U);
}

} // namespace
} // namespace fieldcast::test
