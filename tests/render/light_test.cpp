// SPDX-License-Identifier: Apache-2.0
// Compares direct light with closed forms.
#include "tests/render/render_test.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace fieldcast::render {
namespace {

using LightTest = RenderTest;

/// Irradiance at `p` with normal `n` from a polygon of radiance 1. All of it must be above the horizon.
/// J. H. Lambert. Photometria. 1760; here as in D. Baum et al. SIGGRAPH 1989, equation 3.
double polygon_irradiance(const glm::dvec3& p, const glm::dvec3& n, const std::vector<glm::dvec3>& corners) {
    double sum = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 a = glm::normalize(corners[i] - p);
        const glm::dvec3 b = glm::normalize(corners[(i + 1) % corners.size()] - p);
        sum += std::acos(glm::clamp(glm::dot(a, b), -1.0, 1.0)) * glm::dot(glm::normalize(glm::cross(a, b)), n);
    }
    return 0.5 * std::abs(sum);
}

/// The point of the plane y = `height_m` that the centre of a pixel shows.
glm::dvec3 plane_point(const Camera& camera, std::uint32_t x, std::uint32_t y, double height_m) {
    const glm::dvec3 origin(camera.world_from_camera[3]);
    const glm::vec2 pixel(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
    const glm::dvec3 ray = glm::dvec3(unproject(camera, pixel, 1.0F)) - origin;
    return origin + ray * ((height_m - origin.y) / ray.y);
}

constexpr float kFloor = 3.0F; // metres; away from the origin, where floats are coarser
constexpr float kAlbedo = 0.5F;

SceneBuilder floor_only() {
    SceneBuilder builder;
    builder.add(rectangle({0, kFloor, 0}, {20, 0, 0}, {0, 0, -20}), builder.add_material(diffuse(glm::vec3(kAlbedo))));
    return builder;
}

/// Checks the floor under a light `above_m` over it; the camera beside the light sees the floor only.
void expect_rectangle_light(const Estimate& image, const Camera& camera, float above_m) {
    const std::vector<glm::dvec3> corners{{-0.3, kFloor + above_m, -0.2},
                                          {0.3, kFloor + above_m, -0.2},
                                          {0.3, kFloor + above_m, 0.2},
                                          {-0.3, kFloor + above_m, 0.2}};
    double expected_sum = 0.0;
    double squares = 0.0;
    double variances = 0.0;
    for (std::uint32_t y = 0; y < image.height_px; ++y) {
        for (std::uint32_t x = 0; x < image.width_px; ++x) {
            const double irradiance = polygon_irradiance(plane_point(camera, x, y, kFloor), {0, 1, 0}, corners);
            const double expected = 10.0 * kAlbedo / glm::pi<double>() * irradiance;
            const double error = image.mean[image.index(x, y)].y - expected;
            expected_sum += expected;
            squares += error * error;
            variances += image.variance[image.index(x, y)].y;
        }
    }
    const double count = static_cast<double>(image.mean.size());
    const Average mean = average(image);
    EXPECT_NEAR(mean.mean.y, expected_sum / count, 4.5 * mean.standard_error.y + 1e-5);
    EXPECT_LT(mean.standard_error.y, 0.004 * expected_sum / count);
    // The variance of 384 pixel errors is that of the eight renders within 7 % (√(2/384)); 1.5 is 7 σ.
    EXPECT_LT(squares / variances, 1.5);
}

TEST_F(LightTest, RectangleLightGivesLambertsIrradiance) {
    for (const float above_m : {1.0F, 0.05F}) { // the near light would reveal shadow rays that end too late
        SceneBuilder builder = floor_only();
        builder.add(rectangle({0, kFloor + above_m, 0}, {0.3F, 0, 0}, {0, 0, 0.2F}),
                    builder.add_material(emitter(glm::vec3(10.0F))));
        const glm::vec3 eye = above_m > 0.5F ? glm::vec3(0, kFloor + 0.8F, 1.0F) : glm::vec3(0, kFloor + 0.04F, 0.6F);
        const Camera camera = look_at(eye, {0, kFloor, 0}, above_m > 0.5F ? 0.7F : 0.05F, 24, 16);
        for (const bool nee : {true, false}) {
            const PathTracing options{
                .samples = nee ? 32U : 128U, .renders = 8, .max_bounces = 1, .next_event_estimation = nee};
            SCOPED_TRACE(testing::Message() << above_m << " m, next event estimation " << nee);
            expect_rectangle_light(path_trace(builder.scene(), camera, options), camera, above_m);
        }
    }
}

TEST_F(LightTest, EmissionIsOneSidedUnlessTheMaterialIsDoubleSided) {
    for (const bool both : {false, true}) {
        SceneBuilder builder = floor_only();
        scene::Material material = emitter(glm::vec3(10.0F));
        material.double_sided = both;
        builder.add(rectangle({0, kFloor + 1.0F, 0}, {0.3F, 0, 0}, {0, 0, -0.2F}),
                    builder.add_material(material)); // its front faces up
        const Camera camera = look_at({0, kFloor + 0.8F, 1.0F}, {0, kFloor, 0}, 0.7F, 24, 16);
        const Estimate image = path_trace(builder.scene(), camera, {.samples = 32, .renders = 8, .max_bounces = 1});
        if (both) {
            expect_rectangle_light(image, camera, 1.0F);
        } else {
            EXPECT_EQ(average(image).mean.y, 0.0);
        }
    }
}

/// A floor under one light, seen from above.
class PunctualTest : public RenderTest {
protected:
    void expect(const scene::Light& light, const glm::mat4& place, const auto& irradiance, double tolerance = 2e-4) {
        SceneBuilder builder = floor_only();
        builder.add_light(light, place);
        const Camera camera = look_at({0, kFloor + 4.0F, 0}, {0, kFloor, 0}, 0.9F, 16, 16);
        const Estimate image = path_trace(builder.scene(), camera, {.samples = 4, .renders = 1, .max_bounces = 1});
        for (std::uint32_t y = 0; y < 16; ++y) {
            for (std::uint32_t x = 0; x < 16; ++x) {
                const double expected = kAlbedo / glm::pi<double>() * irradiance(plane_point(camera, x, y, kFloor));
                // One light from one direction has no noise; a few float operations round.
                EXPECT_NEAR(image.mean[image.index(x, y)].y, expected, tolerance * expected + 1e-6) << x << " " << y;
            }
        }
    }

    const glm::dvec3 lamp_{0.5, kFloor + 1.5, -0.25};
};

double inverse_square(const glm::dvec3& to_light) {
    const double distance = glm::length(to_light);
    return to_light.y / (distance * distance * distance);
}

TEST_F(PunctualTest, PointLight) {
    scene::Light light;
    light.type = scene::LightType::kPoint;
    light.intensity = glm::vec3(5.0F);
    expect(light, at(glm::vec3(lamp_)), [&](const glm::dvec3& p) { return 5.0 * inverse_square(lamp_ - p); });
}

TEST_F(PunctualTest, PointLightWithRange) {
    scene::Light light;
    light.type = scene::LightType::kPoint;
    light.intensity = glm::vec3(5.0F);
    light.range_m = 2.0F;
    // KHR_lights_punctual: max(min(1 − (d / range)⁴, 1), 0) / d². Rounding matters more where the window is near 0.
    expect(
        light, at(glm::vec3(lamp_)),
        [&](const glm::dvec3& p) {
            const double ratio = glm::length(lamp_ - p) / 2.0;
            return 5.0 * inverse_square(lamp_ - p) * std::max(0.0, 1.0 - std::pow(ratio, 4.0));
        },
        1e-3);
}

TEST_F(PunctualTest, SpotLight) {
    scene::Light light;
    light.type = scene::LightType::kSpot;
    light.intensity = glm::vec3(5.0F);
    light.inner_cone_rad = 0.3F;
    light.outer_cone_rad = 0.7F;
    const glm::dvec3 axis = glm::normalize(glm::dvec3(-0.4, -1.0, 0.3));
    // KHR_lights_punctual: saturate(cos θ · scale + offset)², which is 1 at the inner and 0 at the outer cone.
    expect(
        light, facing(glm::vec3(lamp_), glm::vec3(axis)),
        [&](const glm::dvec3& p) {
            const double cos_angle = glm::dot(glm::normalize(p - lamp_), axis);
            const double cos_outer = std::cos(0.7);
            const double inside = glm::clamp((cos_angle - cos_outer) / (std::cos(0.3) - cos_outer), 0.0, 1.0);
            return 5.0 * inverse_square(lamp_ - p) * inside * inside;
        },
        1e-3);
}

TEST_F(PunctualTest, DirectionalLight) {
    const glm::dvec3 towards = glm::normalize(glm::dvec3(0.6, -1.0, 0.2));
    for (const float radius : {0.0F, 0.004651F, 0.1F}) {
        scene::Light light;
        light.intensity = glm::vec3(2.0F);
        light.angular_radius_rad = radius;
        // A disc averages cos θ over its directions: 1 − r²/4 of the centre's. Four samples do not average it fully.
        expect(
            light, facing({}, glm::vec3(towards)), [&](const glm::dvec3&) { return 2.0 * -towards.y; },
            radius > 0.01F ? 0.05 : 2e-3);
    }
}

TEST_F(LightTest, EmissiveStrengthCountsBeyondOne) {
    SceneBuilder builder;
    builder.add(rectangle({0, 0, -2}, {1, 0, 0}, {0, 1, 0}), builder.add_material(emitter({7.5F, 20.0F, 0.25F})));
    const Estimate image =
        path_trace(builder.scene(), look_at({0, 0, 0}, {0, 0, -1}, 0.5F, 4, 4), {.samples = 1, .renders = 1});
    EXPECT_EQ(image.mean[5], glm::dvec3(7.5, 20.0, 0.25));
}

TEST_F(LightTest, SceneWithoutLightIsBlack) {
    const Estimate image = path_trace(floor_only().scene(), look_at({0, kFloor + 1.0F, 2}, {0, kFloor, 0}, 0.5F, 8, 8),
                                      {.samples = 4, .renders = 1});
    EXPECT_EQ(average(image).mean, glm::dvec3(0.0));
}

} // namespace
} // namespace fieldcast::render
