// SPDX-License-Identifier: Apache-2.0
// Views that average and denoise their own light: accumulate_views and DenoisedImages::kViews.
#include "core/base/error.h"
#include "core/render/views/view_filter.h"
#include "tests/render/render_test.h"

#include <cmath>

namespace fieldcast::render {
namespace {

constexpr std::uint32_t kWidth = 64;
constexpr std::uint32_t kHeight = 48;
constexpr LatticeGeometry kGeometry{{0.06F, 0.06F}}; // about 1.5 px of disparity per step at the boxes

enum class Pixels { kAll, kHoles };

class ViewFilterTest : public RenderTest {
protected:
    static FrameHeader header_of(std::uint32_t frame, std::uint32_t samples = 1) {
        FrameHeader header = plain_header(room_camera(kWidth, kHeight), samples);
        header.cut = frame == 0;
        header.noise_frame = frame;
        return header;
    }

    static FrameHeader red_header(std::uint32_t frame, Denoiser denoiser) {
        FrameHeader header = header_of(frame);
        header.settings.denoised_images = DenoisedImages::kViews;
        header.settings.denoiser = denoiser;
        header.settings.temporal_accumulation = true;
        return header;
    }

    /// A 3×3 grid. Without guard band, holes appear at the border, too.
    static ViewRequest grid_of(const FrameHeader& header) { return grid_request(header.source, 3, 3, kGeometry); }

    static Views render(Stage& s, const FrameHeader& header) {
        s.gpu_scene.pose(0, header.cut);
        return s.grid.render(s.source.render(header), grid_of(header));
    }

    /// RMS difference of the green channel over all views, over its mean.
    static double error_of(const GridRenderer& grid, const GridRenderer& expected, Pixels pixels = Pixels::kAll) {
        double squared = 0.0;
        double mean = 0.0;
        double count = 0.0;
        for (std::size_t view = 0; view < 9; ++view) {
            const std::vector<bool> mask = expected.hole_mask(view);
            const auto ours = grid.linear_view(view).pixels;
            const auto theirs = expected.linear_view(view).pixels;
            for (std::size_t i = 0; i < mask.size(); ++i) {
                if (pixels == Pixels::kAll || mask[i]) {
                    const double difference = ours[i].y - theirs[i].y;
                    squared += difference * difference;
                    mean += theirs[i].y;
                    count += 1.0;
                }
            }
        }
        return std::sqrt(squared * count) / mean;
    }

    static double mean_of(const GridRenderer& grid) {
        double sum = 0.0;
        for (std::size_t view = 0; view < 9; ++view) {
            for (const glm::vec3& pixel : grid.linear_view(view).pixels) {
                sum += pixel.y / (9.0 * kWidth * kHeight);
            }
        }
        return sum;
    }
};

TEST_F(ViewFilterTest, ViewsAverageTheirLightUntilTheSceneIsCut) {
    Stage s = stage(area_lit_room());
    Stage converged = stage(area_lit_room());
    render(converged, header_of(0, 128));
    FrameHeader header = header_of(0);
    header.settings.accumulate_views = true; // the source itself does not average
    double first = 0.0;
    for (std::uint32_t frame = 0; frame < 12; ++frame) {
        header.cut = frame == 0;
        header.noise_frame = frame;
        render(s, header);
        first = frame == 0 ? error_of(s.grid, converged.grid) : first;
    }
    // α = 0.2 leaves √(α / (2 − α)) = 1/3 of the noise in the limit and 0.35 after twelve frames. The reference adds
    // its own 1/11.
    EXPECT_LT(error_of(s.grid, converged.grid), 0.45 * first);
    header.cut = true;
    render(s, header);
    EXPECT_GT(error_of(s.grid, converged.grid), 0.8 * first);
}

TEST_F(ViewFilterTest, AveragesFollowAMovingCamera) {
    Stage s = stage(area_lit_room());
    Stage converged = stage(area_lit_room());
    FrameHeader header = header_of(0);
    header.settings.accumulate_views = true;
    double first = 0.0;
    for (std::uint32_t frame = 0; frame < 8; ++frame) {
        FrameHeader exact = header_of(0, 128);
        exact.source.world_from_camera[3].x += 0.03F * static_cast<float>(frame); // ¾ of a pixel at the boxes
        header.source = exact.source;
        header.cut = frame == 0;
        header.noise_frame = frame;
        render(s, header);
        if (frame == 0 || frame == 7) {
            render(converged, exact);
        }
        first = frame == 0 ? error_of(s.grid, converged.grid) : first;
    }
    // 0.36 without motion. Pixels that come into view have no history, and taps between pixels blur the light's
    // falloff.
    EXPECT_LT(error_of(s.grid, converged.grid), 0.6 * first);
}

TEST_F(ViewFilterTest, NoiselessLightIsNotChangedByAverages) {
    Stage plain = stage(point_lit_room());
    Stage averaged = stage(point_lit_room());
    Stage red = stage(point_lit_room());
    for (std::uint32_t frame = 0; frame < 3; ++frame) {
        FrameHeader header = header_of(frame);
        header.settings.max_bounces = 1;
        render(plain, header);
        header.settings.accumulate_views = true;
        render(averaged, header);
        header = red_header(frame, Denoiser::kNone);
        header.settings.max_bounces = 1;
        render(red, header);
    }
    // Radiance and a hole's light are half floats, 2^-11 each.
    EXPECT_LT(error_of(averaged.grid, plain.grid), 1e-3);
    EXPECT_LT(error_of(red.grid, plain.grid), 1e-3);
}

TEST_F(ViewFilterTest, FlatLightIsTheSameByBothRoutes) {
    // For convex shapes in a constant sky, every sample of every visible point is 1.
    SceneBuilder builder;
    builder.environment().constant = glm::vec3(1.0F);
    builder.add(box({-0.5F, 0, 0}, glm::vec3(0.3F)), builder.add_material(diffuse({0.8F, 0.2F, 0.1F})));
    Stage green = stage(builder.scene());
    Stage red = stage(builder.scene());
    for (std::uint32_t frame = 0; frame < 3; ++frame) {
        FrameHeader header = red_header(frame, Denoiser::kSvgfPlus);
        header.source = look_at({0.2F, 0.4F, 2}, {-0.4F, 0, 0}, 0.6F, kWidth, kHeight);
        render(red, header);
        header.settings.denoised_images = DenoisedImages::kSource;
        render(green, header);
    }
    EXPECT_LT(error_of(red.grid, green.grid), 0.01); // precision of R11G11B10F for light of almost 1: 2^-7
}

TEST_F(ViewFilterTest, RedRouteHasTheGreensMeanAndLessNoiseInHoles) {
    Stage converged = stage(area_lit_room());
    render(converged, header_of(0, 128));
    const double expected = mean_of(converged.grid);
    Stage noisy = stage(area_lit_room());
    render(noisy, header_of(5));
    for (const Denoiser denoiser : {Denoiser::kSvgf, Denoiser::kSvgfPlus}) {
        SCOPED_TRACE(static_cast<int>(denoiser));
        Stage green = stage(area_lit_room());
        Stage red = stage(area_lit_room());
        for (std::uint32_t frame = 0; frame < 6; ++frame) {
            FrameHeader header = red_header(frame, denoiser);
            render(red, header);
            header.settings.denoised_images = DenoisedImages::kSource;
            render(green, header);
        }
        EXPECT_LT(error_of(red.grid, converged.grid), 0.5 * error_of(noisy.grid, converged.grid));
        const double in_holes = error_of(red.grid, converged.grid, Pixels::kHoles);
        EXPECT_LT(in_holes, 0.7 * error_of(green.grid, converged.grid, Pixels::kHoles)); // holes have one sample each
        // Five frames of 3072 independent pixels with a standard deviation of about three times the mean give 2.4 %.
        EXPECT_LT(std::abs(mean_of(red.grid) - mean_of(green.grid)), 0.05 * expected);
        EXPECT_LT(std::abs(mean_of(red.grid) - expected), 0.05 * expected);
        RecordProperty("red", std::to_string(error_of(red.grid, converged.grid)));
        RecordProperty("green", std::to_string(error_of(green.grid, converged.grid)));
    }
}

TEST_F(ViewFilterTest, AnotherSetOfViewsStartsAnew) {
    Stage s = stage(area_lit_room());
    ViewRequest request = grid_of(header_of(0));
    const std::vector<LatticePosition> all = request.positions;
    const auto take = [&](std::size_t first, std::size_t count) {
        const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
        request.positions.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
    };
    std::uint32_t frame = 0;
    for (const auto& [first, count, is_smaller] :
         {std::tuple(0UL, 4UL, false), std::tuple(2UL, 4UL, false), std::tuple(0UL, 9UL, false),
          std::tuple(7UL, 1UL, false), std::tuple(7UL, 1UL, true), std::tuple(7UL, 2UL, true)}) {
        SCOPED_TRACE(frame);
        take(first, count);
        request.width_px = is_smaller ? kWidth / 2 : kWidth;
        request.height_px = is_smaller ? kHeight / 2 : kHeight;
        const FrameHeader header = red_header(frame++, Denoiser::kSvgf);
        s.gpu_scene.pose(0, header.cut);
        const SourcePlanes& planes = s.source.render(header);
        const Views views = s.grid.render(planes, request);
        GridRenderer fresh(device(), s.gpu_scene);
        const Views expected = fresh.render(planes, request);
        for (std::size_t i = 0; i < count; ++i) {
            EXPECT_EQ(views.views[i].image, expected.views[i].image) << i;
        }
    }
    FrameHeader header = red_header(frame, Denoiser::kSvgf); // the same set of views, whose history is used
    s.gpu_scene.pose(0, false);
    const SourcePlanes& planes = s.source.render(header);
    const Views views = s.grid.render(planes, request);
    GridRenderer fresh(device(), s.gpu_scene);
    EXPECT_NE(views.views[0].image, fresh.render(planes, request).views[0].image);
}

TEST_F(ViewFilterTest, AveragesOfStillFramesAreTheSameByBothRoutes) {
    Stage green = stage(area_lit_room());
    Stage red = stage(area_lit_room());
    for (std::uint32_t frame = 0; frame < 4; ++frame) {
        FrameHeader header = red_header(frame, Denoiser::kSvgf);
        header.settings.accumulate = true;
        const Views by_red = render(red, header);
        header.settings.denoised_images = DenoisedImages::kSource;
        const Views by_green = render(green, header);
        const bool is_same = by_red.views[3].image == by_green.views[3].image;
        EXPECT_EQ(is_same, frame > 0) << frame; // the first frame is not known to be still
    }
}

TEST_F(ViewFilterTest, WhoHoldsTheSceneMakesTheSameViews) {
    Stage server = stage(area_lit_room());
    Stage client = stage(area_lit_room());
    SourcePlanes received(device());
    for (std::uint32_t frame = 0; frame < 3; ++frame) {
        const FrameHeader header = red_header(frame, Denoiser::kSvgfPlus);
        server.gpu_scene.pose(0, header.cut);
        client.gpu_scene.pose(0, header.cut);
        const SourcePlanes& planes = server.source.render(header);
        received.resize(planes.header());
        ASSERT_TRUE(received.upload(planes.download(kSourceSemantics)));
        const Views ours = server.grid.render(planes, grid_of(header));
        const Views theirs = client.grid.render(received, grid_of(header));
        for (std::size_t view = 0; view < ours.views.size(); ++view) {
            EXPECT_EQ(ours.views[view].image, theirs.views[view].image) << frame << ' ' << view;
        }
    }
}

TEST_F(ViewFilterTest, LightOfLayersIsDenoisedInTheSource) {
    SceneBuilder builder;
    builder.environment().constant = glm::vec3(0.4F);
    builder.add(rectangle({0, 0, -1}, {2, 0, 0}, {0, 2, 0}), builder.add_material(diffuse(glm::vec3(0.6F))));
    builder.add(box({0, -0.5F, -0.4F}, glm::vec3(0.3F)), builder.add_material(diffuse(glm::vec3(0.6F))));
    scene::Material pane = diffuse(glm::vec3(0.5F));
    pane.alpha_mode = scene::AlphaMode::kBlend;
    pane.base_colour_factor.a = 0.5F;
    builder.add(rectangle({0.4F, 0, 0}, {0.5F, 0, 0}, {0, 0.5F, 0}), builder.add_material(pane));
    Stage s = stage(builder.scene());
    SourceRenderer other(device(), s.gpu_scene);
    const std::array wanted{PlaneSemantic::kDiffuse};
    for (std::uint32_t frame = 0; frame < 3; ++frame) {
        FrameHeader header = red_header(frame, Denoiser::kSvgf);
        header.source = look_at({0, 0, 3}, {0, 0, 0}, 0.6F, kWidth - 1, kHeight - 1);
        s.gpu_scene.pose(0, header.cut);
        const SourceFrame red = s.source.render(header).download(wanted);
        header.settings.denoised_images = DenoisedImages::kSource;
        const SourceFrame green = other.render(header).download(wanted);
        ASSERT_EQ(red.header.layer_count, kMaxLayers);
        const std::vector<std::byte>& ours = red.planes.front().bytes;
        const std::vector<std::byte>& theirs = green.planes.front().bytes;
        const auto page = static_cast<std::ptrdiff_t>(4 * (kWidth - 1) * (kHeight - 1));
        EXPECT_FALSE(std::equal(ours.begin(), ours.begin() + page, theirs.begin()));
        EXPECT_TRUE(std::equal(ours.begin() + page, ours.end(), theirs.begin() + page));
    }
}

TEST_F(ViewFilterTest, MoreViewsThanTheDeviceHasRoomForAreRefused) {
    Stage s = stage(point_lit_room());
    const FrameHeader header = red_header(0, Denoiser::kSvgf);
    ViewRequest request = grid_request(header.source, 8, 9, kGeometry);
    request.width_px = request.height_px = 8192; // must be refused before allocation
    const SourcePlanes& planes = s.source.render(header);
    try {
        s.grid.render(planes, request);
        ADD_FAILURE() << "no error";
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("72 views of 8192x8192"), std::string::npos) << error.what();
    }
    const std::uint64_t most = ViewFilter::max_pixels(device(), header.settings);
    EXPECT_GT(most, 36U * 320 * 180);
    const std::uint64_t most_fitted = ViewFilter::max_pixels(device(), red_header(0, Denoiser::kBmfr).settings);
    EXPECT_LE(most_fitted, most); // BMFR needs more memory per pixel
    EXPECT_GT(most_fitted, most / 2);
}

} // namespace
} // namespace fieldcast::render
