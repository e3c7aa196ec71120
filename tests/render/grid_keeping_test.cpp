// SPDX-License-Identifier: Apache-2.0
// Data that views keep from frame to frame: its memory is freed, and pauses leave no outdated light.
#include "tests/render/render_test.h"

namespace fieldcast::render {
namespace {

constexpr std::uint32_t kWidth = 64;
constexpr std::uint32_t kHeight = 48;
constexpr LatticeGeometry kGeometry{{0.06F, 0.06F}};

class GridKeepingTest : public RenderTest {
protected:
    /// Settings with averaged views and holes filled from the previous frame.
    static FrameHeader header_of(std::uint32_t frame, DenoisedImages images) {
        FrameHeader header = plain_header(room_camera(kWidth, kHeight), 1);
        header.cut = frame == 0;
        header.noise_frame = frame;
        header.settings.accumulate_views = true;
        header.settings.denoised_images = images;
        header.settings.denoiser = images == DenoisedImages::kViews ? Denoiser::kSvgf : Denoiser::kNone;
        header.settings.temporal_accumulation = true;
        return header;
    }

    static ViewRequest grid_of(const FrameHeader& header, std::uint32_t side = 3) {
        return grid_request(header.source, side, side, kGeometry);
    }

    static const SourcePlanes& render_source(Stage& s, const FrameHeader& header) {
        s.gpu_scene.pose(0, header.cut);
        return s.source.render(header);
    }

    static std::vector<std::vector<std::byte>> render(Stage& s, const FrameHeader& header, std::uint32_t side = 3) {
        std::vector<std::vector<std::byte>> pictures;
        for (View& view : s.grid.render(render_source(s, header), grid_of(header, side)).views) {
            pictures.push_back(std::move(view.image.bytes));
        }
        return pictures;
    }
};

TEST_F(GridKeepingTest, ViewsThatPauseBeginAnew) {
    for (const DenoisedImages images : {DenoisedImages::kSource, DenoisedImages::kViews}) {
        Stage paused = stage(area_lit_room());
        Stage fresh = stage(area_lit_room());
        for (std::uint32_t frame = 0; frame < 6; ++frame) {
            const FrameHeader header = header_of(frame, images);
            if (frame < 3) {
                render(paused, header);
            } else {
                render_source(paused, header); // no view is rendered
            }
            render_source(fresh, header);
        }
        const FrameHeader resumed = header_of(6, images);
        EXPECT_EQ(render(paused, resumed), render(fresh, resumed)) << "no light from before the pause may remain";
    }
}

TEST_F(GridKeepingTest, WhatIsForgottenIsMadeAgain) {
    for (const DenoisedImages images : {DenoisedImages::kSource, DenoisedImages::kViews}) {
        Stage s = stage(area_lit_room());
        const FrameHeader header = header_of(0, images);
        const ViewRequest request = grid_of(header);
        EXPECT_GT(s.grid.missing_bytes(header.settings, request), 0U);
        const auto before = render(s, header);
        EXPECT_EQ(s.grid.missing_bytes(header.settings, request), 0U);
        s.grid.forget_all_but({});
        EXPECT_GE(s.grid.missing_bytes(header.settings, request),
                  9 * kWidth * kHeight * GridRenderer::bytes_per_pixel(header.settings));
        EXPECT_EQ(render(s, header), before);
    }
}

TEST_F(GridKeepingTest, WhatIsWantedKeepsItsHistory) {
    Stage s = stage(area_lit_room());
    Stage undisturbed = stage(area_lit_room());
    for (std::uint32_t frame = 0; frame < 4; ++frame) {
        const FrameHeader header = header_of(frame, DenoisedImages::kSource);
        const ViewRequest kept = grid_of(header);
        s.grid.forget_all_but(std::span(&kept, 1));
        EXPECT_EQ(render(s, header), render(undisturbed, header)) << frame;
    }
}

} // namespace
} // namespace fieldcast::render
