// SPDX-License-Identifier: Apache-2.0
#include "core/scene/framing.h"

#include <gtest/gtest.h>
#include <numbers>

namespace fieldcast::scene {
namespace {

constexpr float kAspect = 16.0F / 9.0F;

/// A box between two corners. Its front sides face outwards, or inwards if it is a room.
Mesh box(const glm::vec3& low, const glm::vec3& high, bool is_room) {
    Mesh mesh;
    for (unsigned i = 0; i < 8; ++i) {
        mesh.positions.emplace_back((i & 1U) != 0 ? high.x : low.x, (i & 2U) != 0 ? high.y : low.y,
                                    (i & 4U) != 0 ? high.z : low.z);
    }
    for (const glm::uvec4& side : {glm::uvec4(0, 4, 6, 2), glm::uvec4(1, 3, 7, 5), glm::uvec4(0, 1, 5, 4),
                                   glm::uvec4(2, 6, 7, 3), glm::uvec4(0, 2, 3, 1), glm::uvec4(4, 5, 7, 6)}) {
        const glm::uvec3 first(side.x, side.y, side.z);
        const glm::uvec3 second(side.x, side.z, side.w);
        mesh.triangles.push_back(is_room ? glm::uvec3(first.x, first.z, first.y) : first);
        mesh.triangles.push_back(is_room ? glm::uvec3(second.x, second.z, second.y) : second);
    }
    mesh.normals.resize(mesh.positions.size(), glm::vec3(0.0F, 1.0F, 0.0F));
    return mesh;
}

Scene scene_of(std::vector<Mesh> meshes) {
    Scene scene;
    scene.materials.emplace_back();
    scene.nodes.emplace_back();
    for (std::uint32_t i = 0; i < meshes.size(); ++i) {
        scene.instances.push_back({.node = 0, .mesh = i});
    }
    scene.meshes = std::move(meshes);
    return scene;
}

/// A room with a lamp.
Scene room_of(const Mesh& mesh) {
    Scene scene = scene_of({mesh});
    scene.lights.emplace_back();
    return scene;
}

Framing framing_of(const Scene& scene, const FramingOptions& options = {}) {
    return find_framing(scene, RayProbe(scene, pose_scene(scene, 0)), options, kAspect);
}

/// Position of `point` in the image, −1 to 1 in x and y; z is the depth.
glm::vec3 seen_at(const Framing& framing, Scene scene, const glm::vec3& point) {
    add_camera(scene, framing, std::nullopt);
    const glm::mat4 pose = camera_pose(pose_scene(scene, 0), scene.cameras.back());
    const glm::vec3 local = glm::inverse(pose) * glm::vec4(point, 1.0F);
    const float slope = std::tan(0.5F * framing.fovy_rad);
    return {local.x / (-local.z * slope * kAspect), local.y / (-local.z * slope), -local.z};
}

TEST(Framing, ShowsAWholeObjectWhateverItsSize) {
    for (const float size : {0.002F, 1.0F, 2000.0F}) {
        SCOPED_TRACE(size);
        const Scene scene = scene_of({box(glm::vec3(size, 0.0F, 0.0F), size * glm::vec3(3.0F, 4.0F, 1.0F), false)});
        const Framing framing = framing_of(scene);
        EXPECT_FALSE(framing.is_inside) << "inside a solid object all visible sides are back sides";
        float largest = 0.0F;
        for (const glm::vec3& corner : scene.meshes[0].positions) {
            const glm::vec3 at = seen_at(framing, scene, corner);
            EXPECT_GT(at.z, 0.0F);
            largest = std::max({largest, std::abs(at.x), std::abs(at.y)});
        }
        EXPECT_LE(largest, 1.0F);
        EXPECT_GT(largest, 0.85F) << "the object must fill the frame";
        EXPECT_GT(framing.from.y, framing.at.y) << "the camera must be above the subject";
        EXPECT_GT(framing.from.z, framing.at.z) << "the camera must be in front of the subject";
    }
}

TEST(Framing, StandsInsideARoomAndLooksAlongIt) {
    const Scene scene = room_of(box({0.0F, 0.0F, 0.0F}, {12.0F, 3.0F, 4.0F}, true));
    const Framing framing = framing_of(scene);
    ASSERT_TRUE(framing.is_inside);
    EXPECT_NEAR(framing.from.y, 1.6F, 0.01F) << "the camera must be at eye height";
    EXPECT_GT(framing.from.x * (12.0F - framing.from.x), 0.0F);
    const glm::vec3 direction = glm::normalize(framing.at - framing.from);
    EXPECT_GT(std::abs(direction.x), 0.9F) << "the camera must look along x, where the room is longest";
    EXPECT_GT(glm::distance(framing.from, framing.at), 6.0F) << "the camera must stand at one end, not in the middle";
}

TEST(Framing, ARoomThatIsNotInMetresHasEyesInItsMiddle) {
    const Scene scene = room_of(box({0.0F, 0.0F, 0.0F}, {1200.0F, 300.0F, 400.0F}, true));
    const Framing framing = framing_of(scene);
    ASSERT_TRUE(framing.is_inside);
    EXPECT_NEAR(framing.from.y, 0.45F * 300.0F, 1.0F);
}

TEST(Framing, NobodyStandsInADarkBox) {
    const Scene scene = scene_of({box({0.0F, 0.0F, 0.0F}, {12.0F, 3.0F, 4.0F}, true)});
    EXPECT_FALSE(framing_of(scene).is_inside) << "a closed room without light must be seen from outside";
}

TEST(Framing, WhatIsSaidCounts) {
    const Scene scene = room_of(box({0.0F, 0.0F, 0.0F}, {12.0F, 3.0F, 4.0F}, true));
    const Framing framing =
        framing_of(scene, {.look_from = glm::vec3(1.0F, 2.0F, 3.0F), .look_at = glm::vec3(2.0F), .fovy_rad = 0.5F});
    EXPECT_EQ(framing.from, glm::vec3(1.0F, 2.0F, 3.0F));
    EXPECT_EQ(framing.at, glm::vec3(2.0F));
    EXPECT_EQ(framing.fovy_rad, 0.5F);
    const Framing same = framing_of(scene, {.look_from = glm::vec3(2.0F), .look_at = glm::vec3(2.0F)});
    EXPECT_NE(same.from, same.at) << "equal points must still give a direction";
}

TEST(Framing, AnOrbitTurnsRoundTheSubjectAndComesBack) {
    Scene scene = scene_of({box(glm::vec3(-1.0F), glm::vec3(1.0F), false)});
    const Framing framing = framing_of(scene, {.orbit_s = 8.0});
    add_camera(scene, framing, 8.0);
    EXPECT_EQ(scene.duration_s, 8.0);
    const auto at = [&](double time_s) {
        const auto pose = pose_scene(scene, static_cast<std::int64_t>(time_s * 1e9));
        return camera_pose(pose, scene.cameras.back());
    };
    const float radius = glm::distance(framing.from, framing.at);
    for (const double time_s : {0.0, 1.0, 2.0, 3.5, 6.0, 8.0}) {
        const glm::mat4 pose = at(time_s);
        EXPECT_NEAR(glm::distance(glm::vec3(pose[3]), framing.at), radius, 1e-3F * radius);
        const glm::vec3 ahead = -glm::vec3(pose[2]);
        EXPECT_GT(glm::dot(ahead, glm::normalize(framing.at - glm::vec3(pose[3]))), 0.999F) << time_s;
    }
    EXPECT_NEAR(glm::distance(glm::vec3(at(4.0)[3]), glm::vec3(at(0.0)[3])),
                2.0F * glm::length(glm::vec2(framing.from.x - framing.at.x, framing.from.z - framing.at.z)), 0.01F);
    EXPECT_LT(glm::distance(glm::vec3(at(8.0)[3]), glm::vec3(at(0.0)[3])), 1e-3F);
}

TEST(Framing, AVerticalLookHasAnImage) {
    const Scene scene = scene_of({box(glm::vec3(-1.0F), glm::vec3(1.0F), false)});
    const Framing framing = framing_of(scene, {.look_from = glm::vec3(0.0F, 9.0F, 0.0F), .look_at = glm::vec3(0.0F)});
    const glm::vec3 at = seen_at(framing, scene, {0.0F, 1.0F, 0.0F});
    EXPECT_NEAR(at.x, 0.0F, 1e-4F);
    EXPECT_NEAR(at.z, 8.0F, 1e-3F);
}

/// Disparity of a point at `depth_m` between the outermost views, as a share of the width.
float disparity(float depth_m, float spacing_m, float convergence_m, std::uint32_t count, float fovy_rad) {
    const float width_over_focal = 2.0F * std::tan(0.5F * fovy_rad) * kAspect;
    return static_cast<float>(count - 1) * spacing_m / width_over_focal * std::abs(1.0F / depth_m - 1.0F / convergence_m);
}

TEST(Framing, ViewsAreComfortableWhateverTheSize) {
    for (const float size : {0.002F, 1.0F, 2000.0F}) {
        SCOPED_TRACE(size);
        const Scene scene = scene_of({box(glm::vec3(0.0F), glm::vec3(size), false)});
        Scene seen = scene;
        const RayProbe probe(scene, pose_scene(scene, 0));
        const Framing framing = find_framing(scene, probe, {}, kAspect);
        add_camera(seen, framing, std::nullopt);
        const auto depths =
            depth_range(probe, camera_pose(pose_scene(seen, 0), seen.cameras.back()), framing.fovy_rad, kAspect);
        ASSERT_TRUE(depths.has_value());
        EXPECT_LT(depths->near_m, depths->middle_m);
        EXPECT_LT(depths->middle_m, depths->far_m);
        const float spacing = comfortable_spacing(*depths, depths->middle_m, 6, framing.fovy_rad, kAspect);
        EXPECT_GT(spacing, 0.0F);
        for (const float depth : {depths->near_m, depths->middle_m, depths->far_m}) {
            EXPECT_LE(disparity(depth, spacing, depths->middle_m, 6, framing.fovy_rad), 1.001F * kComfortableDisparity);
        }
        const float infinite = std::numeric_limits<float>::infinity();
        EXPECT_LE(disparity(infinite, spacing, depths->middle_m, 6, framing.fovy_rad), 3.003F * kComfortableDisparity);
    }
}

TEST(Framing, ProbesSeeInstancesWhereTheyAre) {
    Scene scene = scene_of({box(glm::vec3(-1.0F), glm::vec3(1.0F), false)});
    scene.nodes[0].translation = {0.0F, 0.0F, -10.0F};
    scene.nodes[0].scale = {1.0F, 1.0F, -2.0F}; // mirrored
    const RayProbe probe(scene, pose_scene(scene, 0));
    const auto hit = probe.trace(glm::vec3(0.0F), {0.0F, 0.0F, -1.0F});
    ASSERT_TRUE(hit.has_value());
    EXPECT_NEAR(hit->distance_m, 8.0F, 1e-4F);
    EXPECT_TRUE(hit->is_front) << "in glTF the front of a mirrored triangle is the other side";
    EXPECT_FALSE(probe.trace(glm::vec3(0.0F), {0.0F, 0.0F, 1.0F}).has_value());
    EXPECT_FALSE(probe.trace({0.0F, 0.0F, -10.0F}, {0.0F, 0.0F, -1.0F})->is_front);
}

} // namespace
} // namespace fieldcast::scene
