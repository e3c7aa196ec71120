// SPDX-License-Identifier: Apache-2.0
#include "core/scene/draw_geometry.h"
#include "core/scene/rigid_groups.h"
#include "tests/render/render_test.h"

#include <map>

namespace fieldcast::render {
namespace {

using DrawGeometryTest = RenderTest;

/// Two static boxes, one of them scaled, and two spheres below a sliding node.
scene::Scene mobile() {
    SceneBuilder builder;
    const std::uint32_t white = builder.add_material(diffuse(glm::vec3(0.5F)));
    scene::Material veil = diffuse(glm::vec3(0.5F));
    veil.alpha_mode = scene::AlphaMode::kBlend;
    builder.add(box({0, 0, 0}, {1, 2, 3}), white);
    builder.add(box({0, 0, 0}, {1, 1, 1}), white, glm::mat4(glm::mat3(3.0F)) * at({5, 0, 0}));
    const std::uint32_t sliding = builder.add_node(at({0, 4, 0}));
    builder.add(sphere(1.0F, 32, Shading::kSmooth), white, at({2, 0, 0}));
    builder.add(sphere(0.5F, 32, Shading::kFlat), builder.add_material(veil), at({-2, 0, 0}));
    builder.slide(sliding, {0, 4, 0}, {0, 5, 0});
    scene::Scene scene = builder.scene();
    for (const std::uint32_t instance : {2U, 3U}) {
        scene::Node& node = scene.nodes[scene.instances[instance].node];
        node.parent = sliding;
        node.is_animated = true;
    }
    return scene;
}

TEST(RigidGroups, HoldWhatMovesTogether) {
    const scene::Scene scene = mobile();
    const auto groups = scene::rigid_groups(scene, scene::pose_scene(scene, 0));
    ASSERT_EQ(groups.size(), 2U);
    EXPECT_EQ(groups[0].node, scene::kNone);
    ASSERT_EQ(groups[0].parts.size(), 2U);
    EXPECT_EQ(groups[0].parts[1].group_from_object[3], glm::vec4(15, 0, 0, 1)); // world space
    EXPECT_EQ(groups[1].node, scene.channels[0].node);
    ASSERT_EQ(groups[1].parts.size(), 2U);
    EXPECT_EQ(groups[1].parts[0].instance, 2U);
    EXPECT_EQ(groups[1].parts[0].group_from_object[3], glm::vec4(2, 0, 0, 1)); // space of the sliding node
}

TEST_F(DrawGeometryTest, FirstVerticesNumberEveryTriangleOnce) {
    const scene::Scene scene = mobile();
    const scene::ScenePose pose = scene::pose_scene(scene, 0);
    const scene::DrawGeometry geometry(device(), scene, pose);
    const auto vertices = gpu::read_buffer_as<scene::DrawVertex>(
        device(), geometry.vertices(), geometry.vertices().size_bytes() / sizeof(scene::DrawVertex));
    const auto indices =
        gpu::read_buffer_as<glm::uvec3>(device(), geometry.indices(), geometry.indices().size_bytes() / 12);
    const auto names = gpu::read_buffer_as<glm::uvec2>(device(), geometry.triangles(), geometry.triangle_count());
    ASSERT_EQ(indices.size(), geometry.triangle_count());

    std::map<std::pair<std::uint32_t, std::uint32_t>, glm::vec3> middles; // of (instance, primitive), in the group
    for (const glm::uvec3& corners : indices) {
        const glm::uvec2 name = names.at(vertices[corners.x].triangle);
        const glm::vec3 middle =
            (vertices[corners.x].position + vertices[corners.y].position + vertices[corners.z].position) / 3.0F;
        EXPECT_TRUE(middles.try_emplace({name.x, name.y}, middle).second) << name.x << ' ' << name.y;
    }
    std::size_t expected = 0;
    for (const scene::RigidGroup& group : scene::rigid_groups(scene, pose)) {
        for (const scene::RigidPart& part : group.parts) {
            const scene::Mesh& mesh = scene.meshes[scene.instances[part.instance].mesh];
            for (std::uint32_t primitive = 0; primitive < mesh.triangles.size(); ++primitive, ++expected) {
                const glm::uvec3& t = mesh.triangles[primitive];
                const glm::vec3 middle = (mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]) / 3.0F;
                const glm::vec3 placed(part.group_from_object * glm::vec4(middle, 1.0F));
                const auto found = middles.find({part.instance, primitive});
                ASSERT_NE(found, middles.end());
                EXPECT_LT(glm::distance(found->second, placed), 1e-5F * glm::length(placed) + 1e-6F);
            }
        }
    }
    EXPECT_EQ(middles.size(), expected);
}

TEST_F(DrawGeometryTest, BoxesHoldTheirClusters) {
    const scene::Scene scene = mobile();
    const scene::DrawGeometry geometry(device(), scene, scene::pose_scene(scene, 0));
    const auto vertices = gpu::read_buffer_as<scene::DrawVertex>(
        device(), geometry.vertices(), geometry.vertices().size_bytes() / sizeof(scene::DrawVertex));
    const auto indices =
        gpu::read_buffer_as<std::uint32_t>(device(), geometry.indices(), geometry.indices().size_bytes() / 4);
    std::uint32_t next = 0; // clusters are contiguous, so that one call can draw neighbours
    for (const scene::DrawGroup& group : geometry.groups()) {
        for (const auto& clusters : group.clusters) {
            for (const scene::TriangleCluster& cluster : clusters) {
                EXPECT_EQ(cluster.first_index, next);
                next += cluster.index_count;
                for (std::uint32_t i = cluster.first_index; i < next; ++i) {
                    const glm::vec3 from_centre = glm::abs(vertices[indices[i]].position - cluster.centre);
                    EXPECT_TRUE(glm::all(glm::lessThanEqual(from_centre, cluster.half_size * 1.0001F + 1e-6F)));
                }
            }
        }
    }
    EXPECT_EQ(next, indices.size());
    const auto& sphere = geometry.groups()[1].clusters[0];
    EXPECT_EQ(sphere.size(), 8U); // for 960 triangles
    for (const scene::TriangleCluster& part : sphere) {
        EXPECT_LT(part.half_size.x * part.half_size.y * part.half_size.z, 0.3F); // the box of the whole sphere has 1
    }
}

} // namespace
} // namespace fieldcast::render
