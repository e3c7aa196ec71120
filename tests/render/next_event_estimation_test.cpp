// SPDX-License-Identifier: Apache-2.0
#include "tests/render/render_test.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace fieldcast::render {
namespace {

/// A scene with diffuse, glossy, metallic and thin glass surfaces. Its lights are a textured sky, a double-sided
/// emitter with a texture, and a large emissive ball.
SceneBuilder mixed_scene() {
    SceneBuilder builder;
    scene::Environment& sky = builder.environment();
    sky.width_px = 32;
    sky.height_px = 16;
    for (std::uint32_t i = 0; i < 512; ++i) {
        const float x = static_cast<float>(i % 32);
        const float y = static_cast<float>(i / 32);
        const float glow = 4.0F * std::exp(-0.05F * ((x - 20.0F) * (x - 20.0F) + (y - 5.0F) * (y - 5.0F)));
        sky.pixels.push_back(glm::vec3(0.3F + glow, 0.4F + glow, 0.6F + 0.5F * glow));
    }
    scene::Material panel = emitter({2.0F, 1.5F, 1.0F});
    panel.double_sided = true;
    panel.emissive.texture =
        builder.add_texture(2, {255, 200, 150, 255, 120, 120, 120, 255, 90, 160, 255, 255, 255, 255, 255, 255});
    scene::Material plastic = diffuse({0.2F, 0.4F, 0.7F});
    plastic.ior = 1.5F;
    plastic.roughness_factor = 0.3F;
    scene::Material pane = diffuse({0.7F, 0.9F, 0.8F});
    pane.ior = 1.5F;
    pane.roughness_factor = 0.4F;
    pane.transmission_factor = 0.8F;
    builder.add(rectangle({0, -1, 0}, {3, 0, 0}, {0, 0, -3}), builder.add_material(diffuse(glm::vec3(0.6F))));
    builder.add(rectangle({-1.6F, 0, -0.5F}, {0, 0, 1}, {0, 0.8F, 0}), builder.add_material(panel));
    builder.add(sphere(0.4F, 32, Shading::kSmooth), builder.add_material(emitter(glm::vec3(1.5F))),
                at({1.5F, 0.6F, -1}));
    builder.add(sphere(0.5F, 32, Shading::kSmooth), builder.add_material(metal({0.9F, 0.7F, 0.4F}, 0.35F)),
                at({-0.5F, -0.5F, 0}));
    builder.add(sphere(0.5F, 32, Shading::kSmooth), builder.add_material(plastic), at({0.7F, -0.5F, 0.2F}));
    builder.add(rectangle({0.1F, -0.4F, 0.9F}, {0.4F, 0, 0}, {0, 0.5F, 0}), builder.add_material(pane));
    return builder;
}

using NextEventEstimationTest = RenderTest;

TEST_F(NextEventEstimationTest, DoesNotChangeTheMean) {
    const scene::Scene scene = mixed_scene().scene();
    const Camera camera = look_at({0, 0.6F, 4}, {0, -0.3F, 0}, 0.7F, 32, 24);
    const auto render = [&](bool nee) {
        return average(
            path_trace(scene, camera, {.samples = nee ? 64U : 128U, .renders = 8, .next_event_estimation = nee}));
    };
    const Average with = render(true);
    const Average without = render(false);
    for (int c = 0; c < 3; ++c) {
        const double error = std::hypot(with.standard_error[c], without.standard_error[c]);
        RecordProperty("difference_" + std::to_string(c),
                       std::to_string((with.mean[c] - without.mean[c]) / without.mean[c]));
        EXPECT_LE(4.0 * error, 0.01 * without.mean[c]) << "1 % must be at least four standard errors";
        EXPECT_NEAR(with.mean[c], without.mean[c], 0.01 * without.mean[c]) << c;
    }
}

TEST_F(NextEventEstimationTest, ChoosingLightSamplesDoesNotChangeTheMean) {
    SceneBuilder builder = mixed_scene();
    scene::Light lamp;
    lamp.type = scene::LightType::kPoint;
    lamp.intensity = {1.0F, 0.6F, 0.3F};
    builder.add_light(lamp, at({0, 2, 1}));
    const scene::Scene& scene = builder.scene();
    const Camera camera = look_at({0, 0.6F, 4}, {0, -0.3F, 0}, 0.7F, 32, 24);
    const auto render = [&](LightSampling sampling) {
        return average(path_trace(scene, camera, {.samples = 256, .renders = 8, .light_sampling = sampling}));
    };
    const Average plain = render(LightSampling::plain());
    for (const LightSampling sampling : {LightSampling{1, true}, LightSampling{4, false}, LightSampling{5, true}}) {
        const Average chosen = render(sampling);
        for (int c = 0; c < 3; ++c) {
            const double error = std::hypot(plain.standard_error[c], chosen.standard_error[c]);
            EXPECT_LE(3.0 * error, 0.005 * plain.mean[c]) << "0.5 % must be at least three standard errors";
            EXPECT_NEAR(chosen.mean[c], plain.mean[c], 0.005 * plain.mean[c])
                << sampling.candidates << (sampling.each_kind ? " of each kind" : "");
        }
    }
}

/// Many lamps of equal power, each of which lights only its part of the floor.
TEST_F(NextEventEstimationTest, CandidatesLowerTheVarianceOfManyLights) {
    SceneBuilder builder;
    builder.add(rectangle({0, 0, 0}, {4, 0, 0}, {0, 0, -4}), builder.add_material(diffuse(glm::vec3(0.5F))));
    const std::uint32_t lamp = builder.add_material(emitter(glm::vec3(20.0F)));
    for (int i = 0; i < 64; ++i) {
        builder.add(sphere(0.05F, 8, Shading::kFlat), lamp,
                    at({static_cast<float>(i % 8) - 3.5F, 0.4F, static_cast<float>(i / 8) - 3.5F}));
    }
    const Camera camera = look_at({0, 5.0F, 0.5F}, {0, 0, 0}, 0.8F, 24, 16);
    const auto variance = [&](std::uint32_t candidates) {
        const Estimate image =
            path_trace(builder.scene(), camera,
                       {.samples = 4, .renders = 16, .max_bounces = 1, .light_sampling = {candidates, false}});
        double sum = 0.0;
        for (const glm::dvec3& v : image.variance) {
            sum += v.y;
        }
        return sum;
    };
    // One of 64 lamps gives most of a point's light; eight candidates include it eight times as often.
    EXPECT_LT(variance(8), 0.4 * variance(1));
}

TEST_F(NextEventEstimationTest, LowersTheVariance) {
    const scene::Scene scene = area_lit_room();
    const Camera camera = room_camera(24, 16);
    const auto variance = [&](bool nee) {
        const Estimate image = path_trace(scene, camera, {.samples = 16, .renders = 8, .next_event_estimation = nee});
        double sum = 0.0;
        for (const glm::dvec3& v : image.variance) {
            sum += v.y;
        }
        return sum;
    };
    // One bounce in about 20 hits a light of 1.44 m² in a room of 22 m²; the measured factor is 10 and more.
    EXPECT_LT(variance(true), 0.25 * variance(false));
}

/// With well distributed samples, the mean squared error falls faster than 1/n.
TEST_F(NextEventEstimationTest, SamplesOfAPixelAreWellDistributed) {
    // With one bounce, the irradiance of an unoccluded rectangle light has a smooth two-dimensional integrand. For it,
    // 64 scrambled Sobol points are far better than independent ones.
    SceneBuilder builder;
    builder.add(rectangle({0, 0, 0}, {5, 0, 0}, {0, 0, -5}), builder.add_material(diffuse(glm::vec3(0.5F))));
    builder.add(rectangle({0, 2, 0}, {0.7F, 0, 0}, {0, 0, 0.7F}), builder.add_material(emitter(glm::vec3(5.0F))));
    const Camera camera = look_at({0, 1.5F, 0.5F}, {0, 0, 0}, 0.5F, 16, 16);
    const auto variance = [&](std::uint32_t samples) { // variance of one render
        const Estimate image =
            path_trace(builder.scene(), camera, {.samples = samples, .renders = 8, .max_bounces = 1});
        double sum = 0.0;
        for (const glm::dvec3& v : image.variance) {
            sum += 8.0 * v.y;
        }
        return sum / static_cast<double>(image.variance.size());
    };
    const double falls = variance(1) / variance(64);
    RecordProperty("variance_1_over_64", std::to_string(falls));
    EXPECT_GT(falls, 150.0); // independent samples would give 64
}

} // namespace
} // namespace fieldcast::render
