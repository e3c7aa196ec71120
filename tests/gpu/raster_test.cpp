// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/raster_pipeline.h"
#include "tests/gpu/draw_number_frag.spv.h"
#include "tests/gpu/draw_number_vert.spv.h"
#include "tests/gpu/gpu_test.h"

#include <glm/glm.hpp>

namespace fieldcast::gpu {
namespace {

constexpr std::uint32_t kNone = ~0U;

struct Vertex {
    glm::vec4 place; ///< clip space
    std::uint32_t number;
};

struct Push {
    glm::vec2 moved{0.0F};
    std::uint32_t added = 0;
};

const RasterCode kCode = {{"draw_number_vert", draw_number_vert_spv}, {"draw_number_frag", draw_number_frag_spv}};

RasterPipelineDesc description() {
    RasterPipelineDesc desc;
    desc.layout.push_bytes = sizeof(Push);
    desc.vertex = {{VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Vertex, place)},
                   {VK_FORMAT_R32_UINT, offsetof(Vertex, number)}};
    desc.vertex_bytes = sizeof(Vertex);
    desc.colours = {VK_FORMAT_R32_UINT, VK_FORMAT_R8_UINT};
    return desc;
}

/// Three triangles: the left half at depth 0.5 (number 10), everything at depth 0.25 (20), and the left half at depth
/// 0.75, seen from its back (30). Other vertices than the first have numbers that must not show.
class RasterTest : public GpuTest {
protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped()) {
            return;
        }
        const std::vector<Vertex> values = {
            {{-1, -1, 0.5F, 1}, 10},  {{0, -1, 0.5F, 1}, 98},  {{-1, 7, 0.5F, 1}, 98}, // steep: beyond the picture
            {{-9, -1, 0.25F, 1}, 20}, {{9, -1, 0.25F, 1}, 98}, {{0, 9, 0.25F, 1}, 98},
            {{-1, -1, 0.75F, 1}, 30}, {{-1, 7, 0.75F, 1}, 98}, {{0, -1, 0.75F, 1}, 98}};
        vertices_ = make_buffer<Vertex>(device(), values);
        indices_ = make_buffer<std::uint32_t>(device(), std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8});
        target_ = RasterTarget(device(), {8, 2, 2, description().colours});
    }

    /// Numbers of the pixels of a layer, row by row.
    std::vector<std::vector<std::uint32_t>> numbers(CommandRecorder& recorder) {
        const Buffer copy(device(), 16 + 2 * 80);
        target_.copy_to(recorder, 0, copy, 16, 80, 2);
        recorder.submit();
        return {read_buffer_as<std::uint32_t>(device(), copy, 16, 16),
                read_buffer_as<std::uint32_t>(device(), copy, 16, 96)};
    }

    std::vector<std::uint8_t> marks(CommandRecorder& recorder) {
        const Buffer copy(device(), 32);
        target_.copy_to(recorder, 1, copy, 0, 16, 1);
        recorder.submit();
        return read_buffer_as<std::uint8_t>(device(), copy, 16);
    }

    struct Draw {
        const RasterPipeline& pipeline;
        std::vector<std::uint32_t> triangles; ///< in this order
        Push push{};
    };

    /// Everything that a layer shows.
    void draw(CommandRecorder& recorder, const std::vector<Draw>& draws, std::uint32_t layer = 0) {
        RasterPass pass(recorder, target_, layer);
        pass.use_triangles(vertices_, indices_);
        for (const Draw& one : draws) {
            pass.use(one.pipeline, {});
            pass.push(one.push);
            for (const std::uint32_t triangle : one.triangles) {
                pass.draw(3 * triangle, 3);
            }
        }
    }

    Buffer vertices_;
    Buffer indices_;
    RasterTarget target_;
};

TEST_F(RasterTest, WhatIsNearerStaysFromBothSidesAndInAnyOrder) {
    const RasterPipeline pipeline(device(), kCode, description());
    CommandRecorder recorder(device());
    target_.begin(recorder);
    draw(recorder, {{pipeline, {0, 1, 2}}});
    draw(recorder, {{pipeline, {2, 1, 0}}}, 1);
    const auto seen = numbers(recorder);
    // Pixel centres lie at x = −0.875 … 0.875 and y = ±0.5, the slanting side of the left triangles at x = −(y + 1) /
    // 8: −0.06 in the first row, right of the fourth centre (−0.125), and −0.19 in the second.
    EXPECT_EQ(seen[0], (std::vector<std::uint32_t>{30, 30, 30, 30, 20, 20, 20, 20, 30, 30, 30, 20, 20, 20, 20, 20}));
    EXPECT_EQ(seen[1], seen[0]);
}

TEST_F(RasterTest, WhatIsNotDrawnKeepsAllOnes) {
    const RasterPipeline pipeline(device(), kCode, description());
    CommandRecorder recorder(device());
    target_.begin(recorder);
    draw(recorder, {{pipeline, {0}, {.moved = {1, 0}, .added = 0}}});
    const std::vector<std::uint32_t> seen = numbers(recorder)[0];
    EXPECT_EQ(std::vector(seen.begin(), seen.begin() + 8),
              (std::vector<std::uint32_t>{kNone, kNone, kNone, kNone, 10, 10, 10, 10}));
}

TEST_F(RasterTest, PushConstantsAndSpecialisationsReachBothShaders) {
    const std::vector<Specialisation> factor = {{7, 5}};
    const RasterPipeline pipeline(device(), kCode, description(), factor);
    CommandRecorder recorder(device());
    target_.begin(recorder);
    draw(recorder, {{pipeline, {1}, {.moved = {0, 0}, .added = 2}}});
    EXPECT_THAT(numbers(recorder)[0], testing::Each(102U));
}

TEST_F(RasterTest, APipelineWritesOnlyItsImagesAndMayLeaveDepthAlone) {
    RasterPipelineDesc marking = description();
    marking.written = 2;
    marking.writes_depth = false;
    const RasterPipeline mark(device(), kCode, marking);
    RasterPipelineDesc numbering = description();
    numbering.written = 1;
    const RasterPipeline number(device(), kCode, numbering);
    const std::vector<Draw> draws = {{mark, {2}}, {number, {1}}}; // the nearest first, but it leaves no depth
    CommandRecorder recorder(device());
    target_.begin(recorder);
    draw(recorder, draws);
    const std::vector<std::uint8_t> seen = marks(recorder);
    EXPECT_EQ(seen[0], 3U);
    EXPECT_EQ(seen[7], 255U);
    CommandRecorder again(device());
    target_.begin(again);
    draw(again, draws);
    EXPECT_THAT(numbers(again)[0], testing::Each(20U));
}

TEST_F(RasterTest, PicturesBeyondTheDevicesLimitsAreRefused) {
    const std::uint32_t side = device().info().max_image_side;
    EXPECT_THROW(RasterTarget(device(), {side + 1, 1, 1, {VK_FORMAT_R32_UINT}}), VulkanError);
}

} // namespace
} // namespace fieldcast::gpu
