// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/acceleration_structure.h"
#include "core/gpu/command_recorder.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/trace_triangle.spv.h"

#include <glm/gtc/matrix_transform.hpp>

namespace fieldcast::gpu {
namespace {

struct TracePush {
    std::uint64_t origins = 0;
    std::uint64_t hits = 0;
    std::uint32_t accept = 0;
    std::uint32_t unused = 0;
};

/// One triangle in the plane z = 0, with corners (0, 0), (1, 0), (0, 1).
class AccelerationStructureTest : public GpuTest {
protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !device().info().has_ray_query) {
            GTEST_SKIP() << device().info().name << " has no ray queries";
        }
    }

    AccelerationStructure triangle(bool is_opaque) {
        vertices_ = make_buffer<float>(device(), std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
        indices_ = make_buffer<std::uint32_t>(device(), std::vector<std::uint32_t>{0, 1, 2});
        return AccelerationStructure::bottom_level(device(), {.vertex_address = vertices_.address(),
                                                              .vertex_count = 3,
                                                              .index_address = indices_.address(),
                                                              .triangle_count = 1,
                                                              .is_opaque = is_opaque});
    }

    static TopLevelInstance moved(const AccelerationStructure& level, float x_m, std::uint32_t custom_index) {
        return {.world_from_object = glm::translate(glm::mat4(1.0F), glm::vec3(x_m, 0, 0)),
                .custom_index = custom_index,
                .bottom_level_address = level.address()};
    }

    /// Hits of rays from (x, 0.25, 2) along −z.
    std::vector<glm::vec4> trace(const AccelerationStructure& world, const std::vector<float>& xs_m, bool accept) {
        std::vector<glm::vec4> origins;
        for (const float x_m : xs_m) {
            origins.emplace_back(x_m, 0.25F, 2.0F, 0.0F);
        }
        const BindingLayout layout(device(), {{0, BindingType::kAccelerationStructure}});
        BindingSet set(device(), layout);
        set.set(0, world);
        const Kernel kernel(device(), {"trace_triangle", trace_triangle_spv}, {{&layout}, sizeof(TracePush)});
        const auto input = make_buffer<glm::vec4>(device(), origins);
        const Buffer hits(device(), origins.size() * sizeof(glm::vec4));
        CommandRecorder recorder(device());
        recorder.dispatch(kernel, {&set}, TracePush{input.address(), hits.address(), accept ? 1U : 0U},
                          {static_cast<std::uint32_t>(origins.size())});
        recorder.submit();
        return read_buffer_as<glm::vec4>(device(), hits, origins.size());
    }

private:
    Buffer vertices_;
    Buffer indices_;
};

TEST_F(AccelerationStructureTest, OpaqueTrianglesAreHitWithoutCandidates) {
    const auto level = triangle(true);
    const auto instance = moved(level, 0.0F, 7);
    const auto world = AccelerationStructure::top_level(device(), std::span(&instance, 1));
    const auto hits = trace(world, {0.25F, 2.0F}, false);
    EXPECT_EQ(hits[0], glm::vec4(2, 7, 0, 0));
    EXPECT_EQ(hits[1], glm::vec4(-1, 0, 0, 0));
}

TEST_F(AccelerationStructureTest, CandidatesAreTheKernelsChoice) {
    const auto level = triangle(false);
    const auto instance = moved(level, 0.0F, 7);
    const auto world = AccelerationStructure::top_level(device(), std::span(&instance, 1));
    EXPECT_EQ(trace(world, {0.25F}, true).front(), glm::vec4(2, 7, 0, 1));
    EXPECT_EQ(trace(world, {0.25F}, false).front(), glm::vec4(-1, 0, 0, 1));
}

TEST_F(AccelerationStructureTest, InstanceCanMakeOpaqueGeometryReportCandidates) {
    const auto level = triangle(true);
    auto instance = moved(level, 0.0F, 7);
    instance.is_opaque = false;
    const auto world = AccelerationStructure::top_level(device(), std::span(&instance, 1));
    EXPECT_EQ(trace(world, {0.25F}, true).front(), glm::vec4(2, 7, 0, 1));
}

TEST_F(AccelerationStructureTest, RebuildMovesAndRemovesInstances) {
    const auto level = triangle(true);
    std::vector<TopLevelInstance> instances = {moved(level, 0.0F, 1), moved(level, 5.0F, 2)};
    auto world = AccelerationStructure::top_level(device(), instances);
    const auto before = trace(world, {0.25F, 5.25F, 10.25F}, false);
    EXPECT_EQ(before[0].y, 1.0F);
    EXPECT_EQ(before[1].y, 2.0F);
    EXPECT_EQ(before[2].x, -1.0F);

    const auto later = moved(level, 10.0F, 3);
    world.rebuild(device(), std::span(&later, 1));
    const auto after = trace(world, {0.25F, 5.25F, 10.25F}, false);
    EXPECT_EQ(after[0].x, -1.0F);
    EXPECT_EQ(after[1].x, -1.0F);
    EXPECT_EQ(after[2], glm::vec4(2, 3, 0, 0));
    EXPECT_THROW(world.rebuild(device(), std::vector<TopLevelInstance>(3)), std::logic_error);
}

TEST_F(AccelerationStructureTest, WorldMayBeEmpty) {
    const auto world = AccelerationStructure::top_level(device(), {});
    EXPECT_EQ(trace(world, {0.25F}, false).front().x, -1.0F);
}

} // namespace
} // namespace fieldcast::gpu
