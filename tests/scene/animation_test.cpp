// SPDX-License-Identifier: Apache-2.0
#include "tests/scene/gltf_builder.h"

#include <gmock/gmock.h>

namespace fieldcast::scene {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// A triangle whose node has one animation channel.
GltfBuilder animated(const char* path, const std::vector<float>& times, const std::vector<float>& values,
                     const char* interpolation) {
    GltfBuilder builder;
    builder.add_triangle();
    const bool is_rotation = std::string(path) == "rotation";
    const int input = builder.add_floats(times, "SCALAR");
    const int output = builder.add_floats(values, is_rotation ? "VEC4" : "VEC3");
    builder.add("animations", {{"name", "a"},
                               {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
                               {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}});
    return builder;
}

glm::vec3 position_at(const Scene& scene, double time_s) {
    return pose_scene(scene, static_cast<std::int64_t>(time_s * 1e9)).world_from_node.at(0)[3];
}

TEST(PoseScene, InterpolatesTranslations) {
    const std::vector<float> times{1, 2, 4};
    const std::vector<float> values{0, 0, 0, 1, 0, 0, 3, 0, 0};
    const Scene linear = animated("translation", times, values, "LINEAR").load();
    EXPECT_EQ(linear.duration_s, 4.0);
    EXPECT_FLOAT_EQ(position_at(linear, 0.5).x, 0.0F); // constant before the first key
    EXPECT_FLOAT_EQ(position_at(linear, 1.5).x, 0.5F);
    EXPECT_FLOAT_EQ(position_at(linear, 3.0).x, 2.0F);
    const Scene step = animated("translation", times, values, "STEP").load();
    EXPECT_EQ(position_at(step, 1.9).x, 0.0F);
    EXPECT_EQ(position_at(step, 2.0).x, 1.0F);
    EXPECT_EQ(position_at(step, 4.0).x, 3.0F);
}

TEST(PoseScene, InterpolatesCubicSplines) {
    // The curve goes from 0 to 1 in two seconds, with speed 1 at the start and 0 at the end:
    // p(t) = 0 + (t³ − 2t² + t) · 2 · 1 + (3t² − 2t³) · 1 with t = 0.5: 0.125 · 2 + 0.5.
    const Scene scene =
        animated("translation", {0, 2}, {9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 9, 9, 9}, "CUBICSPLINE").load();
    EXPECT_FLOAT_EQ(position_at(scene, 1.0).x, 0.75F);
    EXPECT_FLOAT_EQ(position_at(scene, 0.0).x, 0.0F);
    EXPECT_FLOAT_EQ(position_at(scene, 2.0).x, 1.0F);
}

TEST(PoseScene, RotatesTheShorterWayAndScales) {
    const float half = 0.70710678F;
    // The second key is −q of a quarter turn about Z.
    const Scene turn = animated("rotation", {0, 1}, {0, 0, 0, 2, 0, 0, -half, -half}, "LINEAR").load();
    const glm::vec3 x = pose_scene(turn, kSecond_ns / 2).world_from_node[0][0];
    EXPECT_NEAR(x.x, half, 1e-6F);
    EXPECT_NEAR(x.y, half, 1e-6F);
    const Scene grow = animated("scale", {0, 1}, {1, 1, 1, 3, -1, 0}, "LINEAR").load();
    const glm::mat4 end = pose_scene(grow, kSecond_ns).world_from_node[0];
    EXPECT_EQ(end[0].x, 3.0F);
    EXPECT_EQ(end[1].y, -1.0F);
    EXPECT_EQ(end[2].z, 0.0F);
}

TEST(PoseScene, ReadsNormalisedIntegerRotations) {
    GltfBuilder builder = animated("rotation", {0}, {0, 0, 0, 1}, "STEP");
    const int output = builder.add_accessor(std::vector<std::int16_t>{0, 32767, 0, 0}, "VEC4", kI16, true);
    builder.json["animations"][0]["samplers"][0]["output"] = output;
    const Scene scene = builder.load();
    EXPECT_EQ(scene.channels.at(0).values.at(0), glm::vec4(0, 1, 0, 0));
    EXPECT_EQ(pose_scene(scene, 0).world_from_node[0][0].x, -1.0F);
}

TEST(PoseScene, LoopsAndShowsTheLastKeyOfEachLoop) {
    const Scene scene = animated("translation", {0, 1}, {0, 0, 0, 1, 0, 0}, "LINEAR").load();
    EXPECT_EQ(position_at(scene, 0.0).x, 0.0F);
    EXPECT_EQ(position_at(scene, 1.0).x, 1.0F);
    EXPECT_NEAR(position_at(scene, 1.25).x, 0.25F, 1e-6F);
    EXPECT_EQ(position_at(scene, 3.0).x, 1.0F);
    EXPECT_NEAR(position_at(scene, -0.25).x, 0.75F, 1e-6F);
    EXPECT_EQ(loop_index(scene, 0), 0);
    EXPECT_EQ(loop_index(scene, kSecond_ns), 0);
    EXPECT_EQ(loop_index(scene, kSecond_ns + 2000), 1);
    EXPECT_EQ(loop_index(scene, 3 * kSecond_ns), 2);
    EXPECT_EQ(loop_index(Scene{}, kSecond_ns), 0);
    Scene short_lived; // the loop index would exceed 64 bits
    short_lived.duration_s = 1e-40;
    EXPECT_EQ(loop_index(short_lived, std::numeric_limits<std::int64_t>::max()), 0);
}

TEST(PoseScene, ReachesTheLastOfThirtyFramesDespiteRounding) {
    const Scene scene = animated("translation", {0, 29.0F / 30.0F}, {0, 0, 0, 29, 0, 0}, "LINEAR").load();
    for (std::int64_t frame = 0; frame < 30; ++frame) {
        const std::int64_t time_ns = (frame * kSecond_ns + 15) / 30; // rounded to the nearest nanosecond
        EXPECT_NEAR(pose_scene(scene, time_ns).world_from_node[0][3].x, static_cast<float>(frame), 1e-4F) << frame;
        EXPECT_EQ(loop_index(scene, time_ns), 0);
    }
    EXPECT_EQ(loop_index(scene, kSecond_ns), 1);
}

TEST(PoseScene, MarksEverythingBelowAnAnimatedNode) {
    GltfBuilder builder = animated("translation", {0, 1}, {0, 0, 0, 1, 0, 0}, "LINEAR");
    builder.json["nodes"][0]["children"] = {1};
    builder.add("nodes", {{"children", {2}}});
    builder.add("nodes", nlohmann::json::object());
    builder.add_node({{"name", "still"}});
    const Scene scene = builder.load();
    EXPECT_TRUE(scene.nodes[0].is_animated);
    EXPECT_TRUE(scene.nodes[2].is_animated);
    EXPECT_FALSE(scene.nodes[3].is_animated);
    EXPECT_EQ(pose_scene(scene, kSecond_ns).world_from_node[2][3].x, 1.0F);
}

TEST(CameraPose, DropsScaleAndMirroring) {
    Scene scene;
    scene.nodes.resize(1);
    scene.nodes[0].scale = {-2, 3, 0.5};
    scene.nodes[0].translation = {1, 2, 3};
    CameraNode camera;
    const glm::mat4 pose = camera_pose(pose_scene(scene, 0), camera);
    EXPECT_EQ(pose[0], glm::vec4(1, 0, 0, 0));
    EXPECT_EQ(pose[1], glm::vec4(0, 1, 0, 0));
    EXPECT_EQ(pose[2], glm::vec4(0, 0, 1, 0));
    EXPECT_EQ(pose[3], glm::vec4(1, 2, 3, 1));
    scene.nodes[0].scale = glm::vec3(0);
    EXPECT_FLOAT_EQ(glm::determinant(camera_pose(pose_scene(scene, 0), camera)), 1.0F);
}

TEST(GltfAnimations, IgnoresMorphTargetsAndTargetsWithoutNode) {
    GltfBuilder builder = animated("translation", {0, 1}, {0, 0, 0, 1, 0, 0}, "LINEAR");
    auto& channels = builder.json["animations"][0]["channels"];
    channels.push_back({{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}});
    channels.push_back({{"sampler", 0}, {"target", {{"path", "translation"}}}});
    const Scene scene = builder.load();
    EXPECT_EQ(scene.channels.size(), 1U);
    EXPECT_THAT(scene.warnings, testing::ElementsAre("morph target animations are ignored (1 channel)"));
}

TEST(GltfAnimations, RefusesBrokenChannels) {
    const std::vector<float> two{0, 0, 0, 1, 0, 0};
    EXPECT_THAT(refusal(animated("translation", {0, 0}, two, "LINEAR")),
                HasSubstr("animation 0 'a': node 0 'triangle': times are negative or not increasing"));
    EXPECT_THAT(refusal(animated("translation", {-1, 0}, two, "LINEAR")), HasSubstr("times are negative"));
    EXPECT_THAT(refusal(animated("translation", {0, 2e6F}, two, "LINEAR")), HasSubstr("lasts longer than 1000000 s"));
    EXPECT_THAT(refusal(animated("translation", {0, NAN}, two, "LINEAR")),
                HasSubstr("element 1 is not a finite number"));
    EXPECT_THAT(refusal(animated("translation", {0, 1}, {0, 0, 0, INFINITY, 0, 0}, "LINEAR")),
                HasSubstr("element 1 is not a finite number"));
    EXPECT_THAT(refusal(animated("translation", {0, 1, 2}, two, "LINEAR")), HasSubstr("as many values as times"));
    EXPECT_THAT(refusal(animated("translation", {0, 1}, two, "CUBICSPLINE")), HasSubstr("as many values as times"));
    EXPECT_THAT(refusal(animated("translation", {0, 1}, two, "BEZIER")), HasSubstr("unknown interpolation 'BEZIER'"));
    EXPECT_THAT(refusal(animated("shear", {0, 1}, two, "LINEAR")), HasSubstr("unknown path 'shear'"));
    EXPECT_THAT(refusal(animated("rotation", {0, 1}, {0, 0, 0, 1, 0, 0, 0, 0}, "LINEAR")), HasSubstr("not a rotation"));
    EXPECT_THAT(refusal(animated("translation", {0, 1}, {0, 0, 0, 0, 3e9F, 0}, "LINEAR")), HasSubstr("farther than"));
    GltfBuilder builder = animated("translation", {0, 1}, two, "LINEAR");
    builder.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    EXPECT_THAT(refusal(builder), HasSubstr("a node with a matrix cannot be animated"));
    builder = animated("translation", {0, 1}, two, "LINEAR");
    builder.json["animations"][0]["channels"][0]["sampler"] = 1;
    EXPECT_THAT(refusal(builder), HasSubstr("animation 0 'a': sampler 1 does not exist"));
    builder.json["animations"][0]["channels"][0] = {{"sampler", 0}, {"target", {{"node", 9}, {"path", "scale"}}}};
    EXPECT_THAT(refusal(builder), HasSubstr("node 9 does not exist"));
    builder.json["animations"][0]["samplers"][0]["input"] = 77;
    EXPECT_THAT(refusal(builder), HasSubstr("accessor 77 does not exist"));
}

} // namespace
} // namespace fieldcast::scene
