// SPDX-License-Identifier: Apache-2.0
// Both traversals against brute force in double precision: geometry only.
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/traversal_reference.h"

#include <numbers>

namespace fieldcast::scene {
namespace {

constexpr std::uint32_t kSeed = 7;

class TraversalTest : public gpu::GpuTest, public testing::WithParamInterface<Traversal> {
protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && GetParam() == Traversal::kRayQuery && !device().info().has_ray_query) {
            GTEST_SKIP() << device().info().name << " has no ray query";
        }
    }

    std::vector<shared::TraceHit> trace(const Scene& scene, std::span<const shared::TraceRay> rays,
                                        const AccelerationOptions& options = {}) {
        const Acceleration acceleration(device(), scene, pose_scene(scene, 0), GetParam(), options);
        return trace(acceleration, rays);
    }

    std::vector<shared::TraceHit> trace(const Acceleration& acceleration, std::span<const shared::TraceRay> rays) {
        bench::DeviceTracer tracer(device(), acceleration, GetParam());
        const bench::DeviceRays batch(device(), rays);
        tracer.trace_closest(batch);
        return batch.hits();
    }

    void expect_brute_force(const Scene& scene, std::span<const shared::TraceRay> rays,
                            double least_identical = 0.998) {
        const BruteForce reference(scene, pose_scene(scene, 0));
        reference.expect_agreement(rays, trace(scene, rays), least_identical);
    }
};

INSTANTIATE_TEST_SUITE_P(Both, TraversalTest, testing::Values(Traversal::kBvh, Traversal::kRayQuery), traversal_name);

TEST_P(TraversalTest, MeetsWhatBruteForceMeets) {
    std::mt19937 random(kSeed);
    for (const std::size_t count : {1U, 2U, 3U, 4U, 5U, 16U, 17U, 100U, 1000U}) {
        SCOPED_TRACE(count);
        const Scene scene = one_mesh_scene(random_triangles(random, count, 1.0F, 0.3F));
        expect_brute_force(scene, random_rays(random, 2000, 1.0F));
    }
}

TEST_P(TraversalTest, MeetsNothingInAnEmptyScene) {
    std::mt19937 random(kSeed);
    Scene no_triangles = empty_scene();
    no_triangles.meshes.push_back(make_mesh({}));
    add_instance(no_triangles, 0);
    for (const Scene& scene : {empty_scene(), no_triangles}) {
        for (const shared::TraceHit& hit : trace(scene, random_rays(random, 100, 1.0F))) {
            EXPECT_EQ(hit.instance, kNone);
        }
    }
}

TEST_P(TraversalTest, NeverMeetsTrianglesWithoutArea) {
    std::mt19937 random(kSeed);
    std::vector<Corners> triangles = random_triangles(random, 200, 1.0F, 0.2F);
    for (std::size_t i = 0; i < triangles.size(); i += 2) {
        triangles[i][2] = i % 4 == 0 ? triangles[i][1] : 0.5F * (triangles[i][0] + triangles[i][1]);
    }
    triangles.push_back({glm::vec3(0.0F), glm::vec3(0.0F), glm::vec3(0.0F)});
    expect_brute_force(one_mesh_scene(triangles), random_rays(random, 4000, 1.0F));
}

TEST_P(TraversalTest, MeetsTrianglesThatLieInOnePlane) {
    std::mt19937 random(kSeed);
    std::vector<Corners> triangles = random_triangles(random, 300, 1.0F, 0.2F);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        for (glm::vec3& corner : triangles[i]) {
            corner.y = 0.25F;
        }
    }
    // Many triangles at the same distance: which of them is met is anyone's choice.
    expect_brute_force(one_mesh_scene(triangles), random_rays(random, 4000, 1.0F), 0.0);
}

TEST_P(TraversalTest, MeetsIdenticalTriangles) {
    std::mt19937 random(kSeed);
    const std::vector<Corners> triangles(500, random_triangles(random, 1, 1.0F, 1.0F)[0]);
    expect_brute_force(one_mesh_scene(triangles), random_rays(random, 1000, 1.0F), 0.0);
}

TEST_P(TraversalTest, BearsHugeAndTinyCoordinates) {
    std::mt19937 random(kSeed);
    for (const float scale : {1e-3F, 1e6F}) {
        SCOPED_TRACE(scale);
        const Scene scene = one_mesh_scene(random_triangles(random, 300, scale, 0.3F * scale));
        expect_brute_force(scene, random_rays(random, 2000, scale));
    }
    // Far from the origin positions are rounded to 1/16384 of the cube, and so are edges.
    const glm::vec3 far_away(1000.0F, -500.0F, 2000.0F);
    const Scene scene = one_mesh_scene(random_triangles(random, 300, 1.0F, 0.3F, far_away));
    expect_brute_force(scene, random_rays(random, 2000, 1.0F, far_away), 0.99);
}

/// A unit square at z = 0, and one at z = −2, both facing +z, made of a grid of triangles.
Scene two_grids() {
    std::vector<Corners> triangles;
    constexpr int kCells = 16;
    for (const float z : {0.0F, -2.0F}) {
        for (int cell = 0; cell < kCells * kCells; ++cell) {
            const glm::vec3 a(static_cast<float>(cell % kCells) / kCells, static_cast<float>(cell / kCells) / kCells,
                              z);
            const glm::vec3 dx(1.0F / kCells, 0, 0);
            const glm::vec3 dy(0, 1.0F / kCells, 0);
            triangles.push_back({a, a + dx, a + dx + dy});
            triangles.push_back({a, a + dx + dy, a + dy});
        }
    }
    return one_mesh_scene(triangles);
}

TEST_P(TraversalTest, FollowsRaysAlongTheAxes) {
    std::vector<shared::TraceRay> rays;
    for (const float zero : {0.0F, -0.0F}) {
        for (float x = 0.0123F; x < 1.0F; x += 0.03717F) {
            for (float y = 0.0211F; y < 1.0F; y += 0.04133F) {
                rays.push_back({{x, y, 1.0F}, 1e30F, {zero, zero, -1.0F}, 0.0F});
                rays.push_back({{x, y, -1.0F}, 1e30F, {zero, zero, 1.0F}, 0.0F});
                rays.push_back({{x, -1.0F, -y}, 1e30F, {zero, 1.0F, zero}, 0.0F});
                rays.push_back({{x, y, 1.0F}, 1e30F, {0.1F, zero, -1.0F}, 0.0F});
            }
        }
    }
    expect_brute_force(two_grids(), rays);
}

TEST_P(TraversalTest, KeepsToTheRange) {
    const glm::vec3 origin(0.53F, 0.41F, 1.0F);
    const glm::vec3 down(0, 0, -1);
    const std::vector<shared::TraceRay> rays{{origin, 0.999F, down, 0.0F},
                                             {origin, 1.001F, down, 0.0F},
                                             {origin, 1e30F, down, 1.001F},
                                             {origin, 2.999F, down, 1.001F},
                                             {origin, 0.501F, 2.0F * down, 0.0F}};
    const std::vector<shared::TraceHit> hits = trace(two_grids(), rays);
    EXPECT_EQ(hits[0].instance, kNone);
    EXPECT_EQ(hits[1].instance, 0U);
    EXPECT_NEAR(hits[1].t, 1.0F, 1e-5F);
    EXPECT_NEAR(hits[2].t, 3.0F, 1e-5F);
    EXPECT_EQ(hits[3].instance, kNone);
    EXPECT_NEAR(hits[4].t, 0.5F, 1e-5F) << "t counts in lengths of the direction";
}

TEST_P(TraversalTest, BearsVeryUnevenSizes) {
    // Every triangle is half as large as the one before: a tree by surface area is as deep as it can be.
    std::vector<Corners> triangles;
    for (int i = 0; i < 100; ++i) {
        const float size = std::exp2(-static_cast<float>(i) / 2.0F);
        const float z = -size;
        triangles.push_back({glm::vec3(-size, -size, z), glm::vec3(size, -size, z), glm::vec3(0, size, z)});
    }
    std::mt19937 random(kSeed);
    expect_brute_force(one_mesh_scene(triangles), random_rays(random, 4000, 1.0F));
}

/// Two meshes: three still instances, and a cart that moves with a wheel that turns on it.
Scene moving_scene(std::mt19937& random) {
    Scene scene = empty_scene();
    scene.meshes.push_back(make_mesh(random_triangles(random, 60, 0.5F, 0.3F)));
    scene.meshes.push_back(make_mesh(random_triangles(random, 40, 0.4F, 0.3F)));
    add_instance(scene, 0, {-2, 0, 0});
    scene.nodes[add_instance(scene, 1, {2, 0, 0})].scale = {-1.0F, 2.0F, 0.5F};
    add_instance(scene, 0, {0, 2, 0});
    const std::uint32_t cart = add_instance(scene, 0, {0, 0, 0});
    const std::uint32_t load = add_instance(scene, 1, {0, 1, 0}, cart);
    scene.nodes[load].scale = {0.5F, 0.5F, -1.5F};
    const std::uint32_t wheel = add_instance(scene, 1, {0, -1, 0}, cart);
    const float quarter = std::numbers::sqrt2_v<float> / 2.0F;
    scene.channels.push_back(
        {cart, AnimationPath::kTranslation, Interpolation::kLinear, {0.0F, 1.0F}, {{0, 0, -2, 0}, {0, 0, 2, 0}}});
    scene.channels.push_back({wheel,
                              AnimationPath::kRotation,
                              Interpolation::kLinear,
                              {0.0F, 1.0F},
                              {{0, 0, 0, 1}, {quarter, 0, 0, quarter}}});
    for (const std::uint32_t node : {cart, load, wheel}) {
        scene.nodes[node].is_animated = true;
    }
    scene.duration_s = 1.0;
    return scene;
}

TEST_P(TraversalTest, MeetsMovedInstancesWhereTheyAre) {
    std::mt19937 random(kSeed);
    const Scene scene = moving_scene(random);
    const std::vector<shared::TraceRay> rays = random_rays(random, 3000, 2.0F);
    Acceleration acceleration(device(), scene, pose_scene(scene, 0), GetParam());
    for (const std::int64_t time_ns : {0LL, 300'000'000LL, 900'000'000LL}) {
        SCOPED_TRACE(time_ns);
        const ScenePose pose = pose_scene(scene, time_ns);
        acceleration.update(pose);
        BruteForce(scene, pose).expect_agreement(rays, trace(acceleration, rays));
    }
}

TEST_P(TraversalTest, LosesInstancesThatAreScaledToNothing) {
    std::mt19937 random(kSeed);
    Scene scene = moving_scene(random);
    const std::vector<shared::TraceRay> rays = random_rays(random, 2000, 2.0F);
    scene.channels[0].path = AnimationPath::kScale;
    scene.channels[0].values = {glm::vec4(1.0F), glm::vec4(0.0F)};
    scene.channels[0].interpolation = Interpolation::kStep;
    scene.channels[0].times_s = {0.0F, 0.5F};
    Acceleration acceleration(device(), scene, pose_scene(scene, 0), GetParam());
    const ScenePose pose = pose_scene(scene, 700'000'000);
    acceleration.update(pose);
    BruteForce(scene, pose).expect_agreement(rays, trace(acceleration, rays));
}

TEST_P(TraversalTest, SharedMeshesMeetTheSame) {
    std::mt19937 random(kSeed);
    const Scene scene = moving_scene(random);
    const std::vector<shared::TraceRay> rays = random_rays(random, 3000, 2.0F);
    const BruteForce reference(scene, pose_scene(scene, 0));
    reference.expect_agreement(rays, trace(scene, rays, {.share_meshes = true}));
}

TEST_P(TraversalTest, AnyAgreesWithClosest) {
    std::mt19937 random(kSeed);
    const Scene scene = moving_scene(random);
    std::vector<shared::TraceRay> rays = random_rays(random, 3000, 2.0F);
    for (shared::TraceRay& ray : rays) {
        ray.t_max = 2.0F;
    }
    const Acceleration acceleration(device(), scene, pose_scene(scene, 0), GetParam());
    bench::DeviceTracer tracer(device(), acceleration, GetParam());
    const bench::DeviceRays batch(device(), rays);
    tracer.trace_closest(batch);
    tracer.trace_any(batch);
    const std::vector<shared::TraceHit> hits = batch.hits();
    const std::vector<float> transmittances = batch.transmittances();
    for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(transmittances[i], hits[i].instance == kNone ? 1.0F : 0.0F) << "ray " << i;
    }
}

} // namespace
} // namespace fieldcast::scene
