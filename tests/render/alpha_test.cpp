// SPDX-License-Identifier: Apache-2.0
// MASK and BLEND surfaces along primary, shadow and reflected rays.
#include "tests/render/render_test.h"

#include <glm/gtc/constants.hpp>

namespace fieldcast::render {
namespace {

using AlphaTest = RenderTest;

scene::Material black_veil(float alpha) {
    scene::Material material = diffuse(glm::vec3(0.0F));
    material.base_colour_factor.a = alpha;
    material.alpha_mode = scene::AlphaMode::kBlend;
    return material;
}

/// Veils of alpha 0.25 and 0.5 at 1 m and 2 m in front of the origin, and a white sky.
SceneBuilder veils() {
    SceneBuilder builder;
    builder.environment().constant = glm::vec3(1.0F);
    builder.add(rectangle({0, 0, -1}, {5, 0, 0}, {0, 5, 0}), builder.add_material(black_veil(0.25F)));
    builder.add(rectangle({0, 0, -2}, {5, 0, 0}, {0, 5, 0}), builder.add_material(black_veil(0.5F)));
    return builder;
}

constexpr double kThrough = 0.75 * 0.5;

TEST_F(AlphaTest, BlendSurfacesDimWhatIsBehind) {
    const Average mean =
        average(path_trace(veils().scene(), look_at({}, {0, 0, -1}, 0.5F, 16, 16), {.samples = 16, .renders = 8}));
    EXPECT_NEAR(mean.mean.y, kThrough, 4.5 * mean.standard_error.y);
    EXPECT_LT(mean.standard_error.y, 0.005);
}

TEST_F(AlphaTest, EverySegmentOfAPathMeetsBlendSurfacesAnew) {
    // Light passes both veils, is reflected by a mirror, and passes the same triangles again.
    SceneBuilder builder = veils();
    builder.add(rectangle({0, 0, -3}, {5, 0, 0}, {0, 5, 0}), builder.add_material(metal(glm::vec3(1.0F), 0.0F)));
    const Camera camera = look_at({}, {0, 0, -1}, 0.2F, 16, 16);
    for (const bool nee : {true, false}) {
        const Average mean =
            average(path_trace(builder.scene(), camera, {.samples = 32, .renders = 8, .next_event_estimation = nee}));
        // 0.002 is the error of the albedo table at n·v ≈ 1
        EXPECT_NEAR(mean.mean.y, kThrough * kThrough, 4.5 * mean.standard_error.y + 0.002) << nee;
        EXPECT_LT(mean.standard_error.y, 0.005) << nee;
    }
}

TEST_F(AlphaTest, ShadowRaysAreDimmedByTheProduct) {
    SceneBuilder builder = veils();
    builder.environment().constant = glm::vec3(0.0F);
    builder.add(rectangle({0, 0, -3}, {5, 0, 0}, {0, 5, 0}), builder.add_material(diffuse(glm::vec3(0.5F))));
    scene::Light light;
    light.type = scene::LightType::kPoint;
    builder.add_light(light, at({0, 0, 0}));
    const Camera camera = look_at({0, 0, -2.5F}, {0, 0, -3}, 0.02F, 2, 2); // the camera is between veils and wall
    const Estimate image = path_trace(builder.scene(), camera, {.samples = 1, .renders = 1, .max_bounces = 1});
    const double expected = kThrough * 0.5 / glm::pi<double>() / 9.0; // intensity 1 at 3 m
    EXPECT_NEAR(image.mean[0].y, expected, 1e-3 * expected);          // the pixel's centre is not exactly at the centre
}

TEST_F(AlphaTest, ViewsCompositeTheSameTransmittance) {
    const scene::Scene scene = veils().scene();
    const scene::GpuScene gpu_scene(device(), scene, traversal());
    SourceRenderer source(device(), gpu_scene);
    GridRenderer grid(device(), gpu_scene);
    const Camera camera = look_at({}, {0, 0, -1}, 0.5F, 16, 16);
    grid.render(source.render(plain_header(camera, 1)), grid_request(camera, 2, 2, {}));
    for (std::size_t view = 0; view < 4; ++view) {
        for (const glm::vec3& pixel : grid.linear_view(view).pixels) {
            EXPECT_NEAR(pixel.y, static_cast<float>(kThrough), 1e-3F); // precision of half floats
        }
    }
}

/// 2×2 texels: white and opaque on the left, green and transparent on the right.
std::vector<std::uint8_t> half_cut_out() {
    return {255, 255, 255, 255, 0, 255, 0, 0, 255, 255, 255, 255, 0, 255, 0, 0};
}

TEST_F(AlphaTest, MaskedTexelsAreNotThere) {
    SceneBuilder builder;
    scene::Material material = emitter(glm::vec3(3.0F));
    material.alpha_mode = scene::AlphaMode::kMask;
    material.base_colour.texture = builder.add_texture(2, half_cut_out(), scene::Wrap::kClamp);
    builder.add(rectangle({0, 0, -1}, {1, 0, 0}, {0, 1, 0}), builder.add_material(material));
    const Camera camera = look_at({}, {0, 0, -1}, glm::half_pi<float>(), 16, 16);
    const Estimate image = path_trace(builder.scene(), camera, {.samples = 1, .renders = 1});
    EXPECT_EQ(image.mean[image.index(2, 8)].y, 3.0);
    EXPECT_EQ(image.mean[image.index(13, 8)].y, 0.0);
}

TEST_F(AlphaTest, LightSamplingKnowsWhatIsCutOut) {
    // For an emissive rectangle with a cut-out right half, and one that is half transparent, both estimators agree.
    for (const scene::AlphaMode mode : {scene::AlphaMode::kMask, scene::AlphaMode::kBlend}) {
        SceneBuilder builder;
        scene::Material material = emitter(glm::vec3(10.0F));
        material.alpha_mode = mode;
        material.base_colour.texture = builder.add_texture(2, half_cut_out(), scene::Wrap::kClamp);
        builder.add(rectangle({0, 1, 0}, {0.5F, 0, 0}, {0, 0, 0.5F}), builder.add_material(material));
        builder.add(rectangle({0, 0, 0}, {5, 0, 0}, {0, 0, -5}), builder.add_material(diffuse(glm::vec3(0.5F))));
        const Camera camera = look_at({0, 0.8F, 0.8F}, {0, 0, 0}, 0.5F, 16, 16);
        const auto render = [&](bool nee) {
            return average(path_trace(
                builder.scene(), camera,
                {.samples = nee ? 32U : 128U, .renders = 8, .max_bounces = 1, .next_event_estimation = nee}));
        };
        const Average with = render(true);
        const Average without = render(false);
        const double error = std::hypot(with.standard_error.y, without.standard_error.y);
        EXPECT_NEAR(with.mean.y, without.mean.y, 4.5 * error);
        EXPECT_LT(error, 0.01 * with.mean.y); // ignoring the cut-out would double the light
    }
}

} // namespace
} // namespace fieldcast::render
