// SPDX-License-Identifier: Apache-2.0
#include "tests/render/render_test.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace fieldcast::render {
namespace {

using EnvironmentLightTest = RenderTest;

constexpr std::uint32_t kWidth = 64;
constexpr std::uint32_t kHeight = 32;

scene::Environment one_bright_texel(std::uint32_t x, std::uint32_t y, float radiance) {
    scene::Environment environment;
    environment.constant = glm::vec3(0.0F);
    environment.width_px = kWidth;
    environment.height_px = kHeight;
    environment.pixels.assign(std::size_t{kWidth} * kHeight, glm::vec3(0.0F));
    environment.pixels[std::size_t{y} * kWidth + x] = glm::vec3(radiance);
    return environment;
}

/// Direction of a texel's centre: −Z at u = 0.5, +Y at v = 0; looking along −Z, u grows to the right.
glm::vec3 direction_of(std::uint32_t x, std::uint32_t y) {
    const float phi = ((static_cast<float>(x) + 0.5F) / kWidth - 0.5F) * 2.0F * glm::pi<float>();
    const float theta = (static_cast<float>(y) + 0.5F) / kHeight * glm::pi<float>();
    return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

SceneBuilder speck() { // makes the scene not empty, far away from the camera
    SceneBuilder builder;
    builder.add(box({500, 500, 500}, glm::vec3(0.01F)), builder.add_material(diffuse(glm::vec3(0.0F))));
    return builder;
}

TEST_F(EnvironmentLightTest, TexelsAppearWhereTheConventionPutsThem) {
    // Texels next to −Z, +X, +Z (the seam), −X, and to both poles.
    for (const glm::uvec2 texel : {glm::uvec2(32, 15), glm::uvec2(48, 16), glm::uvec2(0, 15), glm::uvec2(63, 15),
                                   glm::uvec2(16, 16), glm::uvec2(20, 0), glm::uvec2(40, 31)}) {
        SceneBuilder builder = speck();
        builder.environment() = one_bright_texel(texel.x, texel.y, 1.0F);
        const Camera camera = look_at({0, 0, 0}, direction_of(texel.x, texel.y), 0.02F, 3, 3);
        const Estimate image = path_trace(builder.scene(), camera, {.samples = 1, .renders = 1});
        // The pixel sees the texel's centre. 1 % allows for the width of a pixel and the filter's precision.
        EXPECT_NEAR(image.mean[4].y, 1.0, 0.01) << texel.x << " " << texel.y;
    }
}

TEST_F(EnvironmentLightTest, LooksUpAndDownWithoutInvalidValues) {
    SceneBuilder builder = speck();
    builder.environment() = one_bright_texel(0, 0, 0.0F);
    builder.environment().pixels.assign(std::size_t{kWidth} * kHeight, glm::vec3(0.25F));
    for (const float up : {1.0F, -1.0F}) { // the middle pixel looks exactly along the pole
        const Estimate image =
            path_trace(builder.scene(), look_at({0, 0, 0}, {0, up, 0}, 0.5F, 5, 5), {.samples = 1, .renders = 1});
        for (const glm::dvec3& pixel : image.mean) {
            EXPECT_NEAR(pixel.y, 0.25, 1e-3);
        }
    }
}

TEST_F(EnvironmentLightTest, SamplingFindsTheLightWhereLookUpsSeeIt) {
    // Irradiance of one bilinear texel is its radiance × its solid angle. The filter spreads it: the integral over u is
    // exact, that over v deviates by the variation of sin θ, 0.2 %.
    const glm::uvec2 texel(40, 6);
    SceneBuilder builder;
    builder.environment() = one_bright_texel(texel.x, texel.y, 100.0F);
    builder.add(rectangle({0, 0, 0}, {5, 0, 0}, {0, 0, -5}), builder.add_material(diffuse(glm::vec3(0.5F))));
    const glm::vec3 direction = direction_of(texel.x, texel.y);
    const double sine = std::sqrt(1.0 - static_cast<double>(direction.y) * static_cast<double>(direction.y));
    const double solid_angle = 2.0 * glm::pi<double>() * glm::pi<double>() / (kWidth * kHeight) * sine;
    const double expected = 0.5 / glm::pi<double>() * 100.0 * solid_angle * static_cast<double>(direction.y);
    const Camera camera = look_at({0, 2, 0}, {0, 0, 0}, 0.5F, 16, 16);
    for (const bool nee : {true, false}) {
        const Average mean = average(
            path_trace(builder.scene(), camera,
                       {.samples = nee ? 64U : 512U, .renders = 8, .max_bounces = 1, .next_event_estimation = nee}));
        EXPECT_NEAR(mean.mean.y, expected, 4.5 * mean.standard_error.y + 0.005 * expected) << nee;
        EXPECT_LT(mean.standard_error.y, 0.02 * expected) << nee;
    }
}

TEST_F(EnvironmentLightTest, LargeMapsAreSampledAsFinelyAsSmallOnes) {
    // The bits of one float that select one of 2²¹ texels leave 3 for the alias decision. This would change the
    // brighter half by several percent. The sky has two halves in a ratio of 1 : 6 (alias decision 2 : 7), and the mean
    // must be that of the same map with few texels.
    const auto render = [&](std::uint32_t width) {
        SceneBuilder builder;
        scene::Environment& environment = builder.environment();
        environment.width_px = width;
        environment.height_px = width / 2;
        environment.pixels.resize(std::size_t{width} * width / 2);
        for (std::size_t i = 0; i < environment.pixels.size(); ++i) {
            environment.pixels[i] = glm::vec3((i % width) * 2 < width ? 1.0F : 6.0F);
        }
        builder.add(rectangle({0, 0, 0}, {5, 0, 0}, {0, 0, -5}), builder.add_material(diffuse(glm::vec3(0.5F))));
        return average(path_trace(builder.scene(), look_at({0, 2, 0}, {0, 0, 0}, 0.5F, 16, 16),
                                  {.samples = 64, .renders = 8, .max_bounces = 1}));
    };
    const Average small = render(64);
    const Average large = render(2048);
    const double error = std::hypot(small.standard_error.y, large.standard_error.y);
    EXPECT_NEAR(large.mean.y, small.mean.y, 4.5 * error);
    EXPECT_LT(error, 0.003);                    // the mean is 1.75
    EXPECT_NEAR(small.mean.y, 0.5 * 3.5, 0.01); // albedo × mean radiance; the seams of the halves are a texel wide
}

} // namespace
} // namespace fieldcast::render
