// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/motion.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace fieldcast::bench {
namespace {

using Mask = std::vector<bool>;

/// Two instances; the second one stands on a cart, an animated node, that rolls 1 m/s along x. The camera turns.
scene::Scene cart_scene() {
    scene::Scene scene;
    scene.nodes.resize(4); // house, cart, load, camera
    scene.nodes[2].parent = 1;
    scene.nodes[2].translation = {0.0F, 1.0F, 0.0F};
    scene.instances = {{.node = 0}, {.node = 2}};
    scene.channels.resize(2);
    scene.channels[0].node = 1;
    scene.channels[0].times_s = {0.0F, 1.0F};
    scene.channels[0].values = {glm::vec4(0.0F), glm::vec4(1, 0, 0, 0)};
    scene.channels[1].node = 3;
    scene.channels[1].path = scene::AnimationPath::kRotation;
    scene.channels[1].times_s = {0.0F, 1.0F};
    scene.channels[1].values = {glm::vec4(0, 0, 0, 1), glm::vec4(0, 1, 0, 0)};
    scene.duration_s = 1.0;
    return scene;
}

TEST(Motion, IsThatOfInstancesOnAnimatedNodes) {
    const scene::Scene scene = cart_scene();
    const Motion motion =
        find_motion(scene, scene::pose_scene(scene, 250'000'000), scene::pose_scene(scene, 500'000'000));
    EXPECT_EQ(motion.is_moving, (Mask{false, true}));
    EXPECT_EQ(motion.before_from_now[0], glm::mat4(1.0F));
    const glm::vec4 before = motion.before_from_now[1] * glm::vec4(0.5F, 1.0F, 0.0F, 1.0F);
    EXPECT_NEAR(before.x, 0.25F, 1e-6F);
    EXPECT_NEAR(before.y, 1.0F, 1e-6F);
}

TEST(Motion, IsNoneAtRest) {
    const scene::Scene scene = cart_scene();
    const scene::ScenePose pose = scene::pose_scene(scene, 250'000'000);
    EXPECT_EQ(find_motion(scene, pose, pose).is_moving, (Mask{false, false}));
}

TEST(MovingMask, WidensByTheMarginInsideTheImage) {
    image::ViewSurfaces surfaces;
    surfaces.camera.width_px = 5;
    surfaces.camera.height_px = 4;
    surfaces.object.assign(20, 0);
    surfaces.object[1 * 5 + 0] = 1;            // at the left border
    surfaces.object[3 * 5 + 4] = scene::kNone; // the sky does not move
    EXPECT_EQ(moving_mask(surfaces, {false, true}, 1), (Mask{
                                                           true,  true,  false, false, false, //
                                                           true,  true,  false, false, false, //
                                                           true,  true,  false, false, false, //
                                                           false, false, false, false, false, //
                                                       }));
    EXPECT_EQ(moving_mask(surfaces, {false, false}, 1), Mask(20, false));
    EXPECT_EQ(moving_mask(surfaces, {false, true}, 100), Mask(20, true));
}

} // namespace
} // namespace fieldcast::bench
