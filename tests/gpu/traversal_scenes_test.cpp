// SPDX-License-Identifier: Apache-2.0
// The traversals and Embree agree on real scenes (conventions.md, "Identity and surfaces").
#include "bench/speed/rays.h"
#include "core/scene/gltf/loader.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/traversal_reference.h"

#include <filesystem>

namespace fieldcast::scene {
namespace {

struct SceneFile {
    const char* name;
    const char* path;
};

constexpr std::array kScenes{SceneFile{"Atelier", "scenes/atelier/atelier.gltf"},
                             SceneFile{"Sponza", "../shared/scenes/sponza/Sponza.gltf"},
                             SceneFile{"BreakfastRoom", "../shared/scenes/breakfast_room/BreakfastRoom.gltf"},
                             SceneFile{"GasStation", "../shared/scenes/gas_station/GasStation.gltf"}};
constexpr std::uint32_t kWidthPx = 192;
constexpr std::uint32_t kHeightPx = 108;
constexpr std::int64_t kTimeNs = 500'000'000;

class TraversalScenesTest : public gpu::GpuTest, public testing::WithParamInterface<SceneFile> {
protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !std::filesystem::exists(GetParam().path)) {
            GTEST_SKIP() << GetParam().path << " is not here";
        }
    }
};

INSTANTIATE_TEST_SUITE_P(Scenes, TraversalScenesTest, testing::ValuesIn(kScenes),
                         [](const auto& scene) { return scene.param.name; });

/// Nearly all hits identical, every other one at the same distance or one of a few that an edge decides.
void expect_agreement(std::span<const shared::TraceHit> expected, std::span<const shared::TraceHit> actual) {
    ASSERT_EQ(expected.size(), actual.size());
    std::size_t different = 0;
    std::size_t elsewhere = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const auto& [t, instance, primitive] = expected[i];
        if (instance == actual[i].instance && (instance == kNone || primitive == actual[i].primitive)) {
            continue;
        }
        ++different;
        const bool both_hit = instance != kNone && actual[i].instance != kNone;
        elsewhere += both_hit && std::abs(actual[i].t - t) <= 1e-4F * t ? 0U : 1U;
    }
    EXPECT_LE(static_cast<double>(different), 0.002 * static_cast<double>(expected.size()));
    // A ray that slips past one side of an edge meets something else behind it: at most 1 in 10,000 was measured.
    EXPECT_LE(static_cast<double>(elsewhere), 0.0002 * static_cast<double>(expected.size()) + 1.0);
}

std::vector<shared::TraceHit> with_embree(const bench::EmbreeTracer& embree, std::span<const shared::TraceRay> rays) {
    std::vector<shared::TraceHit> hits(rays.size());
    embree.trace_closest(rays, hits, 2);
    return hits;
}

TEST_P(TraversalScenesTest, GeometryAgreesWithEmbree) {
    const Scene scene = load_scene(GetParam().path);
    const ScenePose pose = pose_scene(scene, kTimeNs);
    const bench::EmbreeTracer embree(scene, pose);
    const bench::RaySets sets = bench::make_rays(scene, pose, *find_camera(scene), embree, kWidthPx, kHeightPx);
    for (const Traversal traversal : {Traversal::kBvh, Traversal::kRayQuery}) {
        if (traversal == Traversal::kRayQuery && !device().info().has_ray_query) {
            continue;
        }
        SCOPED_TRACE(traversal == Traversal::kBvh ? "bvh" : "ray query");
        Acceleration acceleration(device(), scene, pose_scene(scene, 0), traversal);
        acceleration.update(pose);
        bench::DeviceTracer tracer(device(), acceleration, traversal);
        for (const auto* rays : {&sets.primary, &sets.bounce, &sets.shadow}) {
            const bench::DeviceRays batch(device(), *rays);
            tracer.trace_closest(batch);
            expect_agreement(with_embree(embree, *rays), batch.hits());
        }
    }
}

TEST_P(TraversalScenesTest, TraversalsAgreeOnSurfacesWithAlpha) {
    if (!device().info().has_ray_query) {
        GTEST_SKIP() << device().info().name << " has no ray query";
    }
    const Scene scene = load_scene(GetParam().path);
    const ScenePose pose = pose_scene(scene, kTimeNs);
    const bench::EmbreeTracer embree(scene, pose);
    const bench::RaySets sets = bench::make_rays(scene, pose, *find_camera(scene), embree, kWidthPx, kHeightPx);
    GpuScene own(device(), scene, Traversal::kBvh);
    GpuScene ray_query(device(), scene, Traversal::kRayQuery);
    own.pose(kTimeNs, true);
    ray_query.pose(kTimeNs, true);
    bench::DeviceTracer own_tracer(device(), own);
    bench::DeviceTracer ray_query_tracer(device(), ray_query);
    for (const auto* rays : {&sets.primary, &sets.bounce}) {
        const bench::DeviceRays batch(device(), *rays);
        own_tracer.trace_closest(batch, bench::TraceMode::kStochastic, 5);
        const std::vector<shared::TraceHit> hits = batch.hits();
        ray_query_tracer.trace_closest(batch, bench::TraceMode::kStochastic, 5);
        expect_agreement(batch.hits(), hits);
    }
}

} // namespace
} // namespace fieldcast::scene
