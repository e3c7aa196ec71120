// SPDX-License-Identifier: Apache-2.0
// Kernels that run only on groups with a surface, and must not change other pixels.
#include "core/render/group_list.h"
#include "shaders/shared/frame.h"
#include "tests/render/render_test.h"

#include <array>
#include <numeric>

namespace fieldcast::render {
namespace {

using testing::UnorderedElementsAre;

class GroupListTest : public RenderTest {
protected:
    /// The listed groups, of 32, after the flags of `flagged` were set.
    std::vector<std::uint32_t> listed(const std::vector<std::uint32_t>& flagged, std::uint32_t width_px) {
        GroupList groups(device());
        EXPECT_TRUE(groups.resize(32));
        EXPECT_FALSE(groups.resize(32));
        gpu::CommandRecorder recorder(device());
        groups.clear(recorder);
        recorder.submit();
        for (const std::uint32_t group : flagged) {
            const std::uint32_t one = 1;
            gpu::write_buffer(device(), groups.flags(), std::as_bytes(std::span(&one, 1)), 4ULL * group);
        }
        groups.record(recorder, width_px);
        recorder.barrier();
        recorder.submit();
        return contents(groups);
    }

    std::vector<std::uint32_t> contents(const GroupList& groups) const {
        const auto head = gpu::read_buffer_as<std::uint32_t>(device(), groups.list(), 4);
        EXPECT_EQ(head[1], head[0]); // they fit into one row of workgroups
        EXPECT_EQ(head[2], head[0] > 0 ? 1U : 0U);
        EXPECT_EQ(head[3], 1U);
        return gpu::read_buffer_as<std::uint32_t>(device(), groups.list(), head[0], 16);
    }
};

// Rows have 100 pixels. Group 10 has the pixels 640 to 703. The pixels 639 to 704 touch them in their rows, 539 to 604
// above and 739 to 804 below. These are groups 9 to 11, 8 to 9, and 11 to 12.
TEST_F(GroupListTest, ListsFlaggedGroupsAndThoseThatTouchThem) {
    EXPECT_THAT(listed({10}, 100), UnorderedElementsAre(8, 9, 10, 11, 12));
    EXPECT_THAT(listed({0}, 100), UnorderedElementsAre(0, 1, 2));
    EXPECT_THAT(listed({31}, 100), UnorderedElementsAre(29, 30, 31));
    EXPECT_THAT(listed({}, 100), UnorderedElementsAre());
}

TEST_F(GroupListTest, TilesTouchNoOthers) {
    EXPECT_THAT(listed({3, 10, 31}, 0), UnorderedElementsAre(3, 10, 31));
}

TEST_F(GroupListTest, ListsAll) {
    GroupList groups(device());
    groups.resize(32);
    groups.list_all();
    std::vector<std::uint32_t> all(32);
    std::iota(all.begin(), all.end(), 0U);
    EXPECT_EQ(contents(groups), all);
}

/// Two small veils in front of a wall that does not fill the image. One swings from one end to the other, farther than
/// a group is wide. The other sinks until it is directly below its old position.
scene::Scene moving_veils() {
    SceneBuilder builder;
    scene::Material veil = diffuse(glm::vec3(0.5F));
    veil.alpha_mode = scene::AlphaMode::kBlend;
    veil.base_colour_factor.a = 0.5F;
    builder.add(rectangle({0, 0, -3}, {0.7F, 0, 0}, {0, 0.7F, 0}), builder.add_material(diffuse(glm::vec3(0.7F))));
    const std::uint32_t cloth = builder.add_material(veil);
    const std::uint32_t swinging = builder.add(rectangle({0, 0, 0}, {0.2F, 0, 0}, {0, 0.2F, 0}), cloth);
    const std::uint32_t sinking = builder.add(rectangle({0, 0, 0}, {0.2F, 0, 0}, {0, 0.2F, 0}), cloth);
    builder.slide(builder.scene().instances[swinging].node, {-1.5F, 0, -2}, {1.5F, 0, -2});
    builder.slide(builder.scene().instances[sinking].node, {0, 0.2F, -2}, {0, -0.2F, -2});
    builder.environment().constant = glm::vec3(0.1F);
    builder.add(rectangle({0, 2, -1.5F}, {0.5F, 0, 0}, {0, 0, 0.5F}), builder.add_material(emitter(glm::vec3(50.0F))));
    return builder.scene();
}

// Filters must not read their old results in pixels that had a surface earlier.
TEST_F(GroupListTest, AFrameWithoutHistoryIsThatOfAFreshRenderer) {
    const scene::Scene scene = moving_veils();
    scene::GpuScene gpu_scene(device(), scene, traversal());
    for (const Denoiser denoiser : {Denoiser::kNone, Denoiser::kSvgf, Denoiser::kSvgfPlus, Denoiser::kBmfr}) {
        SCOPED_TRACE(static_cast<int>(denoiser));
        FrameHeader header = plain_header(look_at({}, {0, 0, -1}, 0.6F, 203, 65), 1);
        header.settings.denoiser = denoiser;
        SourceRenderer used(device(), gpu_scene);
        gpu_scene.pose(0, true);
        const SourceFrame before = used.render(header).download(kSourceSemantics);
        gpu_scene.pose(999'999'999, true);
        SourceRenderer fresh(device(), gpu_scene);
        const SourceFrame expected = fresh.render(header).download(kSourceSemantics);
        const SourceFrame frame = used.render(header).download(kSourceSemantics);
        EXPECT_NE(before.planes[0].bytes, expected.planes[0].bytes); // the veils have moved
        for (std::size_t i = 0; i < frame.planes.size(); ++i) {
            EXPECT_EQ(frame.planes[i].bytes, expected.planes[i].bytes) << static_cast<int>(kSourceSemantics[i]);
        }
    }
}

} // namespace
} // namespace fieldcast::render
