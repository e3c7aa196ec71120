// SPDX-License-Identifier: Apache-2.0
// Closed systems whose radiance is known: white furnaces and lit spheres seen from inside (the latter as in the tests
// of M. Pharr, W. Jakob, G. Humphreys. Physically Based Rendering, 4th edition: integrators_test).
#include "tests/render/render_test.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace fieldcast::render {
namespace {

using FurnaceTest = RenderTest;
using SphereInteriorTest = RenderTest;

constexpr std::uint32_t kRoughnesses = 6;
constexpr std::uint32_t kCell = 16; // pixels per sphere

/// Rows of white spheres with roughness 0, 0.2 … 1 under a white sky, one row per material.
scene::Scene furnace(const std::vector<scene::Material>& rows) {
    SceneBuilder builder;
    builder.environment().constant = glm::vec3(1.0F);
    const scene::Mesh ball = sphere(0.45F, 96, Shading::kSmooth);
    for (std::size_t row = 0; row < rows.size(); ++row) {
        for (std::uint32_t col = 0; col < kRoughnesses; ++col) {
            scene::Material material = rows[row];
            material.roughness_factor = static_cast<float>(col) / (kRoughnesses - 1);
            builder.add(ball, builder.add_material(material),
                        at({static_cast<float>(col) - 2.5F,
                            0.5F * static_cast<float>(rows.size() - 1) - static_cast<float>(row), 0}));
        }
    }
    return builder.scene();
}

TEST_F(FurnaceTest, WhiteSpheresVanishInAWhiteSky) {
    scene::Material dielectric = diffuse(glm::vec3(1.0F));
    dielectric.ior = 1.5F;
    scene::Material glass = dielectric;
    glass.transmission_factor = 1.0F;
    const std::vector<scene::Material> rows{dielectric, metal(glm::vec3(1.0F), 0.0F), glass};
    const auto height = static_cast<std::uint32_t>(rows.size());
    // At this distance, one unit is one cell.
    const Camera camera = look_at({0, 0, 60}, {0, 0, 0}, 2.0F * std::atan(0.5F * static_cast<float>(height) / 60.0F),
                                  kCell * kRoughnesses, kCell * height);
    const scene::Scene scene = furnace(rows);
    for (const bool nee : {false, true}) { // without: in a constant sky, sampling the BSDF alone has the least noise
        const Estimate image = path_trace(scene, camera, {.samples = 32, .renders = 4, .next_event_estimation = nee});
        for (std::uint32_t row = 0; row < height; ++row) {
            for (std::uint32_t col = 0; col < kRoughnesses; ++col) {
                const Average cell = average(image, col * kCell, row * kCell, kCell, kCell);
                // Lower bound: light is lost below the horizon of the geometric normal, and in glass after eight
                // bounces. Upper bound: interpolation of the albedo table. Three standard errors allow for noise, which
                // is of that size for rough glass.
                const double noise = 3.0 * cell.standard_error.y;
                EXPECT_GE(cell.mean.y, 0.97 - noise) << "row " << row << " roughness " << 0.2 * col << " nee " << nee;
                EXPECT_LE(cell.mean.y, 1.003 + noise) << "row " << row << " roughness " << 0.2 * col << " nee " << nee;
                EXPECT_LT(noise, 0.03);
                RecordProperty("furnace_" + std::to_string(nee) + std::to_string(row) + std::to_string(col),
                               std::to_string(cell.mean.y) + " +- " + std::to_string(cell.standard_error.y));
            }
        }
    }
}

TEST_F(FurnaceTest, DiffuseSurfacesAreExactFarFromTheOriginAndScaled) {
    // Self-intersection would make pixels of these walls dark: three white walls at 1 km, 100 times as large in object
    // space. They are seen from outside, so all diffuse samples escape to the constant sky and are exactly 1.
    SceneBuilder builder;
    builder.environment().constant = glm::vec3(1.0F);
    const glm::mat4 place = glm::mat4(0.01F, 0, 0, 0, 0, 0.01F, 0, 0, 0, 0, 0.01F, 0, 1000, 20, -700, 1);
    builder.add(box({}, glm::vec3(50.0F)), builder.add_material(diffuse(glm::vec3(1.0F))), place);
    const Camera camera = look_at({1001.5F, 21, -698}, {1000, 20, -700}, 0.5F, 32, 32);
    const Estimate image = path_trace(builder.scene(), camera, {.samples = 16, .renders = 1});
    for (const glm::dvec3& pixel : image.mean) {
        EXPECT_NEAR(pixel.y, 1.0, 1e-4); // rounding of the MIS weights
    }
}

/// A closed ball of radius 1, seen from inside. Its flat faces do not matter to the solution for uniform emission.
SceneBuilder ball(const scene::Material& material) {
    SceneBuilder builder;
    builder.add(turned_inside_out(sphere(1.0F, 96, Shading::kFlat)), builder.add_material(material));
    return builder;
}

Camera inside_camera() {
    return look_at({0, 0, 0.3F}, {0.1F, 0.2F, -1}, 1.2F, 24, 24);
}

TEST_F(SphereInteriorTest, UniformEmissionAddsUpAsAGeometricSeries) {
    scene::Material material = diffuse(glm::vec3(0.5F));
    material.emissive_factor = glm::vec3(0.5F);
    const scene::Scene scene = ball(material).scene();
    const double expected = 1.0 - std::pow(0.5, 9); // sum of 0.5 · 0.5^k, k = 0 … 8 bounces
    for (const bool nee : {true, false}) {
        const Average mean =
            average(path_trace(scene, inside_camera(), {.samples = 32, .renders = 6, .next_event_estimation = nee}));
        EXPECT_NEAR(mean.mean.y, expected, 4.5 * mean.standard_error.y + 1e-4) << nee; // 4.5 σ: 1 in 150 000
        EXPECT_LT(mean.standard_error.y, 0.005) << nee;
    }
}

TEST_F(SphereInteriorTest, PointLightAtTheCentre) {
    SceneBuilder builder = ball(diffuse(glm::vec3(0.5F)));
    scene::Light light;
    light.type = scene::LightType::kPoint;
    light.intensity = glm::vec3(glm::pi<float>());
    builder.add_light(light, glm::mat4(1.0F));
    const Average mean = average(path_trace(builder.scene(), inside_camera(), {.samples = 16, .renders = 6}));
    const double expected = 1.0 - std::pow(0.5, 8); // sum of 0.5^k, k = 1 … 8
    // The ball is a polyhedron: distances are up to 1 − cos(π/96)² = 0.0011 shorter, irradiances that much larger.
    EXPECT_NEAR(mean.mean.y, expected, 4.5 * mean.standard_error.y + 0.0015);
}

} // namespace
} // namespace fieldcast::render
