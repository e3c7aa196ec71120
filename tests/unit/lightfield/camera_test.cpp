// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/camera.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <random>

namespace fieldcast {
namespace {

TEST(Camera, LooksAlongMinusZWithRowsDownwards) {
    const Camera camera = make_camera(glm::mat4(1.0F), 1.0F, 200, 100);
    EXPECT_EQ(project(camera, {0, 0, -3}), glm::vec3(100, 50, 3));
    EXPECT_GT(project(camera, {1, 0, -3}).x, 100.0F);
    EXPECT_LT(project(camera, {0, 1, -3}).y, 50.0F);
    EXPECT_LT(project(camera, {0, 0, 3}).z, 0.0F) << "behind the camera";
}

TEST(Camera, FieldOfViewSpansTheHeight) {
    const Camera camera = make_camera(glm::mat4(1.0F), 1.2F, 333, 100);
    EXPECT_NEAR(vertical_fov(camera), 1.2F, 1e-6F);
    EXPECT_NEAR(project(camera, {0, std::tan(0.6F) * 5.0F, -5}).y, 0.0F, 1e-4F);
    EXPECT_NEAR(project(camera, {0, -std::tan(0.6F) * 5.0F, -5}).y, 100.0F, 1e-4F);
}

TEST(Camera, UnprojectInvertsProject) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    for (int i = 0; i < 1000; ++i) {
        glm::mat4 pose = glm::translate(glm::mat4(1.0F), 3.0F * glm::vec3(unit(random), unit(random), unit(random)));
        pose = glm::rotate(pose, 3.0F * unit(random), glm::normalize(glm::vec3(unit(random), unit(random), 1.5F)));
        Camera camera = make_camera(pose, 1.0F + 0.5F * unit(random), 640, 360);
        camera.principal_px += 100.0F * glm::vec2(unit(random), unit(random)); // sheared
        const glm::vec2 pixel(320.0F + 320.0F * unit(random), 180.0F + 180.0F * unit(random));
        const float depth_m = 11.0F + 10.0F * unit(random);
        const glm::vec3 seen = project(camera, unproject(camera, pixel, depth_m));
        EXPECT_NEAR(seen.x, pixel.x, 0.01F); // 3 m + 21 m in float: 2e-6 m at f ≈ 300 px and 1 m
        EXPECT_NEAR(seen.y, pixel.y, 0.01F);
        EXPECT_NEAR(seen.z, depth_m, 1e-4F);
    }
}

TEST(Camera, GuardBandSeesTheSamePinholeShifted) {
    const Camera camera = make_camera(glm::mat4(1.0F), 1.0F, 640, 360);
    const Camera widened = with_guard_band(camera, {.left_px = 10, .right_px = 20, .top_px = 3, .bottom_px = 4});
    EXPECT_EQ(widened.width_px, 670U);
    EXPECT_EQ(widened.height_px, 367U);
    const glm::vec3 point(0.4F, 0.3F, -2.0F);
    const glm::vec3 shift = project(widened, point) - project(camera, point);
    EXPECT_NEAR(shift.x, 10.0F, 1e-4F);
    EXPECT_NEAR(shift.y, 3.0F, 1e-4F);
    EXPECT_EQ(with_guard_band(camera, {}), camera);
}

} // namespace
} // namespace fieldcast
