// SPDX-License-Identifier: Apache-2.0
#include "tests/scene/gltf_builder.h"

#include <glm/gtc/constants.hpp>
#include <gmock/gmock.h>

namespace fieldcast::scene {
namespace {

using testing::HasSubstr;

GltfBuilder with_light(const nlohmann::json& light) {
    GltfBuilder builder;
    builder.add_triangle();
    builder.json["extensionsUsed"] = {"KHR_lights_punctual"};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = nlohmann::json::array({light});
    builder.add_node({{"name", "lamp"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    return builder;
}

GltfBuilder with_camera(const nlohmann::json& node) {
    GltfBuilder builder;
    builder.add_triangle();
    builder.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}});
    builder.add_node(node);
    return builder;
}

TEST(GltfNodes, PutsParentsBeforeChildren) {
    GltfBuilder builder;
    builder.add_triangle(); // node 0
    builder.json["nodes"] = nlohmann::json::array({{{"name", "leaf"}, {"mesh", 0}, {"translation", {0, 0, 3}}},
                                                   {{"name", "unused"}, {"mesh", 0}},
                                                   {{"name", "middle"}, {"children", {0}}, {"scale", {2, 2, 2}}},
                                                   {{"name", "root"}, {"children", {2}}, {"translation", {1, 0, 0}}}});
    builder.json["scenes"][0]["nodes"] = {3, 3};
    const Scene scene = builder.load();
    ASSERT_EQ(scene.nodes.size(), 3U);
    EXPECT_EQ(scene.nodes[0].name, "root");
    EXPECT_EQ(scene.nodes[2].name, "leaf");
    EXPECT_EQ(scene.nodes[2].parent, 1U);
    EXPECT_EQ(scene.instances.size(), 1U);
    EXPECT_EQ(pose_scene(scene, 0).world_from_node[2][3], glm::vec4(1, 0, 6, 1));
}

TEST(GltfNodes, TakesTheFirstSceneAndAllRootsWithoutAny) {
    GltfBuilder builder;
    const int mesh = builder.add_triangle();
    builder.add("nodes", {{"mesh", mesh}});
    builder.json.erase("scene");
    EXPECT_EQ(builder.load().instances.size(), 1U);
    builder.json.erase("scenes");
    EXPECT_EQ(builder.load().instances.size(), 2U);
}

TEST(GltfNodes, NormalisesRotationsAndKeepsMatrices) {
    GltfBuilder builder;
    builder.add_triangle();
    builder.json["nodes"][0]["rotation"] = {0, 0, 2, 0};
    builder.add_node({{"matrix", {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, -1, 0, 7, 8, 9, 1}}});
    const Scene scene = builder.load();
    EXPECT_EQ(scene.nodes[0].rotation.z, 1.0F);
    ASSERT_TRUE(scene.nodes[1].matrix);
    EXPECT_EQ((*scene.nodes[1].matrix)[3], glm::vec4(7, 8, 9, 1));
    EXPECT_EQ((*scene.nodes[1].matrix)[1].x, 0.5F);
}

TEST(GltfNodes, SurvivesDeepHierarchies) {
    constexpr int kDepth = 50000;
    GltfBuilder builder;
    builder.add_triangle();
    for (int i = 1; i < kDepth; ++i) {
        builder.add("nodes", {{"children", {i - 1}}});
    }
    builder.json["scenes"][0]["nodes"] = {kDepth - 1};
    EXPECT_EQ(builder.load().nodes.size(), static_cast<std::size_t>(kDepth));
}

TEST(GltfNodes, RefusesBrokenGraphs) {
    GltfBuilder builder;
    builder.add_triangle();
    const auto refused_nodes = [&](const nlohmann::json& nodes) {
        GltfBuilder changed = builder;
        for (const nlohmann::json& node : nodes) {
            changed.add("nodes", node);
        }
        return refusal(changed);
    };
    EXPECT_THAT(refused_nodes({{{"children", {1}}}}), HasSubstr("node 1: is its own ancestor"));
    EXPECT_THAT(refused_nodes({{{"children", {2}}}, {{"children", {1}}}}), HasSubstr("is its own ancestor"));
    EXPECT_THAT(refused_nodes({{{"children", {3}}}, {{"children", {3}}}, {{"name", "n"}}}),
                HasSubstr("node 3 'n': has two parents"));
    EXPECT_THAT(refused_nodes({{{"children", {0}}}}), HasSubstr("is not a root"));
    EXPECT_THAT(refused_nodes({{{"children", {99}}}}), HasSubstr("child node 99 does not exist"));
    EXPECT_THAT(refused_nodes({{{"mesh", 5}}}), HasSubstr("node 1: mesh 5 does not exist"));
    EXPECT_THAT(refused_nodes({{{"camera", 5}}}), HasSubstr("camera 5"));
    EXPECT_THAT(refused_nodes({{{"skin", 0}}}), HasSubstr("skin 0"));
    EXPECT_THAT(refused_nodes({{{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}}), HasSubstr("light 0"));
}

TEST(GltfNodes, RefusesBrokenTransforms) {
    const auto refused_with = [](const char* member, const nlohmann::json& value) {
        GltfBuilder builder;
        builder.add_triangle();
        builder.json["nodes"][0][member] = value;
        return refusal(builder);
    };
    EXPECT_THAT(refused_with("translation", {1, 2}), HasSubstr("node 0 'triangle': translation: needs 3 numbers"));
    EXPECT_THAT(refused_with("translation", {1, 2, "3"}), HasSubstr("translation"));
    EXPECT_THAT(refused_with("translation", {1, 2, 1e39}), HasSubstr("translation"));
    EXPECT_THAT(refused_with("translation", {0, 0, 2e9}), HasSubstr("farther than 1e9 m"));
    EXPECT_THAT(refused_with("scale", {1e38, 1e38, 1e38}), HasSubstr("farther than 1e9 m"));
    EXPECT_THAT(refused_with("rotation", {0, 0, 0, 0}), HasSubstr("is not a rotation"));
    EXPECT_THAT(refused_with("matrix", {1, 2, 3}), HasSubstr("matrix needs 16 numbers"));
    EXPECT_THAT(refused_with("matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}), HasSubstr("not affine"));
}

TEST(GltfNodes, RefusesMoreInstancesThanIdsOnTheWire) {
    GltfBuilder builder;
    const int mesh = builder.add_triangle();
    auto& primitives = builder.json["meshes"][0]["primitives"];
    for (int i = 1; i < 2048; ++i) {
        primitives.push_back(primitives[0]);
    }
    for (int i = 1; i < 512; ++i) {
        builder.add_node({{"mesh", mesh}});
    }
    EXPECT_EQ(builder.load().instances.size(), kMaxInstances);
    builder.add_node({{"mesh", mesh}});
    EXPECT_THAT(refusal(builder), HasSubstr("more than 1048576 instances"));
}

TEST(GltfLights, ReadsAllThreeKinds) {
    const Scene sun = with_light({{"type", "directional"}, {"color", {1, 0.5, 0}}, {"intensity", 10}}).load();
    ASSERT_EQ(sun.lights.size(), 1U);
    EXPECT_EQ(sun.lights[0].type, LightType::kDirectional);
    EXPECT_EQ(sun.lights[0].intensity, glm::vec3(10, 5, 0));
    EXPECT_FLOAT_EQ(sun.lights[0].angular_radius_rad, glm::radians(0.2665F));
    EXPECT_EQ(sun.lights[0].node, 1U);
    EXPECT_EQ(sun.lights[0].name, "lamp");
    const Light point = with_light({{"type", "point"}, {"range", 4}}).load().lights.at(0);
    EXPECT_EQ(point.type, LightType::kPoint);
    EXPECT_EQ(point.range_m, 4.0F);
    const Light spot = with_light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}})
                           .load()
                           .lights.at(0);
    EXPECT_EQ(spot.type, LightType::kSpot);
    EXPECT_EQ(spot.inner_cone_rad, 0.1F);
    EXPECT_EQ(spot.outer_cone_rad, 0.2F);
    EXPECT_EQ(spot.range_m, std::numeric_limits<float>::infinity());
}

TEST(GltfLights, TakesTheAngularRadiusFromTheLightOrItsNode) {
    GltfBuilder builder = with_light({{"type", "directional"}, {"extras", {{"angular_radius_deg", 0}}}});
    EXPECT_EQ(builder.load().lights.at(0).angular_radius_rad, 0.0F);
    builder.json["nodes"][1]["extras"]["angular_radius_deg"] = 5;
    EXPECT_FLOAT_EQ(builder.load().lights.at(0).angular_radius_rad, glm::radians(5.0F));
    builder.json["nodes"][1]["extras"]["angular_radius_deg"] = -5;
    EXPECT_THAT(refusal(builder), HasSubstr("light 0: angular_radius_deg"));
}

TEST(GltfLights, RefusesBrokenLights) {
    EXPECT_THAT(refusal(with_light({{"type", "laser"}})), HasSubstr("light 0: unknown type 'laser'"));
    EXPECT_THAT(refusal(with_light({{"type", "point"}, {"intensity", -1}})), HasSubstr("light 0: intensity"));
    EXPECT_THAT(refusal(with_light({{"type", "point"}, {"intensity", 1e300}})), HasSubstr("light 0: intensity"));
    EXPECT_THAT(refusal(with_light({{"type", "point"}, {"color", {1, 1}}})), HasSubstr("color: needs 3 numbers"));
    EXPECT_THAT(refusal(with_light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.3}, {"outerConeAngle", 0.2}}}})),
                HasSubstr("innerConeAngle"));
    EXPECT_THAT(refusal(with_light({{"type", "spot"}, {"spot", {{"outerConeAngle", 3}}}})),
                HasSubstr("outerConeAngle"));
}

TEST(GltfCameras, ReadsFieldOfViewAndSpacing) {
    const Scene scene =
        with_camera({{"name", "Cam"}, {"camera", 0}, {"extras", {{"fieldcast", {{"spacing_m", 0.02}}}}}}).load();
    ASSERT_EQ(scene.cameras.size(), 1U);
    EXPECT_EQ(scene.cameras[0].name, "Cam");
    EXPECT_EQ(scene.cameras[0].fovy_rad, 0.5F);
    EXPECT_EQ(scene.cameras[0].spacing_m, 0.02F);
    EXPECT_EQ(with_camera({{"camera", 0}}).load().cameras.at(0).spacing_m, std::nullopt);
}

TEST(GltfCameras, RefusesBrokenAndIgnoresOrthographicOnes) {
    EXPECT_THAT(refusal(with_camera({{"camera", 0}, {"extras", {{"fieldcast", {{"spacing_m", 0}}}}}})),
                HasSubstr("spacing_m"));
    GltfBuilder builder = with_camera({{"camera", 0}});
    builder.json["cameras"][0]["perspective"]["yfov"] = 4;
    EXPECT_THAT(refusal(builder), HasSubstr("camera 0: yfov"));
    builder.json["cameras"][0] = {{"type", "orthographic"},
                                  {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 9}, {"znear", 0}}}};
    const Scene scene = builder.load();
    EXPECT_TRUE(scene.cameras.empty());
    EXPECT_THAT(scene.warnings, testing::ElementsAre("orthographic cameras are ignored (1 node)"));
}

TEST(FindCamera, PrefersLightField) {
    GltfBuilder builder = with_camera({{"name", "First"}, {"camera", 0}});
    const Scene one = builder.load();
    EXPECT_EQ(find_camera(one)->name, "First");
    EXPECT_EQ(find_camera(one, "LightField"), nullptr);
    builder.add_node({{"name", "LightField"}, {"camera", 0}});
    const Scene two = builder.load();
    EXPECT_EQ(find_camera(two)->name, "LightField");
    EXPECT_EQ(find_camera(two, "First")->name, "First");
    EXPECT_EQ(find_camera(Scene{}), nullptr);
}

} // namespace
} // namespace fieldcast::scene
