// SPDX-License-Identifier: Apache-2.0
// Compares smooth surfaces in views away from the source with the same views path traced.
#include "tests/render/render_test.h"

#include <cmath>

namespace fieldcast::render {
namespace {

constexpr std::uint32_t kWidth = 96;
constexpr std::uint32_t kHeight = 72;
constexpr LatticeGeometry kGeometry{{0.12F, 0.12F}};

enum class Shape { kFloor, kBall };

/// Name, reflecting shape and roughness, and the largest allowed ratio of the errors with and without reflections.
struct Case {
    const char* name;
    Shape shape;
    float roughness;
    double left;
};

/// A smooth floor in front of a wall of emissive stripes, or a smooth ball in a sky of light and dark squares.
scene::Scene smooth_scene(const Case& test) {
    SceneBuilder builder;
    const std::uint32_t smooth = builder.add_material(metal(glm::vec3(0.9F), test.roughness));
    if (test.shape == Shape::kBall) {
        scene::Environment& sky = builder.environment();
        sky.width_px = 64;
        sky.height_px = 32;
        for (std::uint32_t i = 0; i < 64 * 32; ++i) {
            const bool is_light = (i / 4) % 2 == (i / 64 / 4) % 2;
            sky.pixels.push_back(is_light ? glm::vec3(1.5F, 1.2F, 0.8F) : glm::vec3(0.05F, 0.1F, 0.2F));
        }
        builder.add(sphere(0.8F, 96, Shading::kSmooth), smooth);
        return builder.scene();
    }
    scene::Material wall = emitter(glm::vec3(1.0F));
    std::vector<std::uint8_t> stripes;
    for (int i = 0; i < 16; ++i) {
        const std::uint8_t value = i % 2 == 0 ? 230 : 10;
        stripes.insert(stripes.end(), {value, value, static_cast<std::uint8_t>(i % 4 == 0 ? 230 : 10), 255});
    }
    wall.emissive.texture = builder.add_texture(16, stripes);
    builder.add(rectangle({0, -1, 0}, {6, 0, 0}, {0, 0, -6}), smooth);
    builder.add(rectangle({0, 2, -3}, {5, 0, 0}, {0, 3, 0}), builder.add_material(wall));
    return builder.scene();
}

/// Settings of source and reference: one bounce shows the mirrored surface and adds no other light.
RenderSettings settings() {
    RenderSettings settings = plain_header(look_at({}, {0, 0, -1}, 1.0F, 8, 8), 256).settings;
    settings.max_bounces = 1;
    return settings;
}

class ReflectionsTest : public RenderTest, public testing::WithParamInterface<Case> {
protected:
    /// RMSE of the displayed values of a corner view, on the smooth surface.
    double error(Stage& s, const Camera& camera, bool reflections, const std::vector<glm::vec3>& truth) const {
        FrameHeader header = plain_header(camera, 256);
        header.settings = settings();
        header.settings.reflections = reflections;
        ViewRequest request = grid_request(camera, 5, 5, kGeometry);
        request.positions = {request.positions.front()};
        s.grid.render(s.source.render(header), request);
        const std::vector<glm::vec3> pixels = s.grid.linear_view(0).pixels;
        const std::vector<std::uint32_t> instances = s.grid.view_instances(0);
        const std::vector<bool> holes = s.grid.hole_mask(0);
        double sum = 0.0;
        double count = 0.0;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            if (instances[i] == 0 && !holes[i]) {
                const glm::dvec3 difference = glm::clamp(pixels[i], 0.0F, 1.0F) - glm::clamp(truth[i], 0.0F, 1.0F);
                sum += glm::dot(difference, difference) / 3.0;
                count += 1.0;
            }
        }
        EXPECT_GT(count, 500.0);
        return std::sqrt(sum / count);
    }
};

TEST_P(ReflectionsTest, AreWhereEachViewSeesThem) {
    const Case& test = GetParam();
    Stage s = stage(smooth_scene(test));
    const Camera camera = test.shape == Shape::kFloor ? look_at({0, 0.2F, 3}, {0, -0.4F, 0}, 0.8F, kWidth, kHeight)
                                                      : look_at({0, 0, 2.6F}, {0, 0, 0}, 0.8F, kWidth, kHeight);
    const ViewRequest request = grid_request(camera, 5, 5, kGeometry);
    s.reference.start(view_camera(camera, kGeometry, request.positions.front(), vertical_fov(camera), kWidth, kHeight));
    s.reference.accumulate(settings(), 7);
    const std::vector<glm::vec3> truth = s.reference.image();

    const double sticking = error(s, camera, false, truth);
    const double following = error(s, camera, true, truth);
    RecordProperty("sticking", std::to_string(sticking));
    RecordProperty("following", std::to_string(following));
    EXPECT_GT(sticking, 0.05); // several pixels of parallax in bold stripes: there must be an error to reduce
    EXPECT_LT(following, test.left * sticking);
}

INSTANTIATE_TEST_SUITE_P(Surfaces, ReflectionsTest,
                         testing::Values(Case{"mirror", Shape::kFloor, 0.03F, 0.15},
                                         Case{"glossy_floor", Shape::kFloor, 0.15F, 0.15},
                                         Case{"mirror_ball", Shape::kBall, 0.03F, 0.15},
                                         Case{"glossy_ball", Shape::kBall, 0.12F, 0.65}),
                         [](const auto& test) { return test.param.name; });

using RoughSurfacesTest = RenderTest;

TEST_F(RoughSurfacesTest, AreLeftAsTheyAre) {
    Stage s = stage(point_lit_room());
    const Camera camera = look_at({0, 0, 3}, {0, 0, 0}, 0.8F, 64, 48);
    FrameHeader header = plain_header(camera, 1);
    const ViewRequest request = grid_request(camera, 3, 3, kGeometry);
    s.grid.render(s.source.render(header), request);
    const LinearView with = s.grid.linear_view(0);
    header.settings.reflections = false;
    s.grid.render(s.source.render(header), request);
    EXPECT_EQ(s.grid.linear_view(0).pixels, with.pixels);
}

} // namespace
} // namespace fieldcast::render
