// SPDX-License-Identifier: Apache-2.0
#include "tests/render/render_test.h"

namespace fieldcast::render {
namespace {

class ReferenceRendererTest : public RenderTest {};

TEST_F(ReferenceRendererTest, GoesOnWithAnImageThatWasKept) {
    const scene::Scene scene = area_lit_room();
    const scene::GpuScene gpu_scene(device(), scene, traversal());
    const Camera camera = room_camera(32, 24);
    const RenderSettings settings = plain_header(camera, 8).settings;
    ReferenceRenderer whole(device(), gpu_scene);
    whole.start(camera);
    whole.accumulate(settings, 5);
    ReferenceRenderer continued(device(), gpu_scene);
    continued.resume(camera, whole.image(), whole.samples_per_pixel());
    whole.accumulate(settings, 5);
    continued.accumulate(settings, 5);
    EXPECT_EQ(continued.samples_per_pixel(), 16U);
    const std::vector<glm::vec3> expected = whole.image();
    const std::vector<glm::vec3> actual = continued.image();
    for (std::size_t i = 0; i < expected.size(); ++i) {
        // The sum is converted to a mean and back, which rounds floats twice.
        EXPECT_NEAR(actual[i].y, expected[i].y, 1e-6F * expected[i].y + 1e-7F) << i;
    }
}

} // namespace
} // namespace fieldcast::render
