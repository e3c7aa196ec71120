// SPDX-License-Identifier: Apache-2.0
#include "core/scene/ggx_albedo.h"
#include "core/scene/light_tables.h"

#include <gmock/gmock.h>

namespace fieldcast::scene {
namespace {

/// Two instances of an emissive triangle, one of them twice as large in each direction, a sun, and two lamps.
Scene lit_scene() {
    Scene scene;
    Material glowing;
    glowing.emissive_factor = glm::vec3(2.0F);
    scene.materials = {glowing};
    Mesh triangle;
    triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle.normals.assign(3, glm::vec3(0, 0, 1));
    triangle.triangles = {{0, 1, 2}};
    scene.meshes = {triangle};
    scene.nodes.resize(2);
    scene.nodes[1].scale = glm::vec3(2.0F);
    scene.instances = {{0, 0}, {1, 0}};
    Light lamp;
    lamp.type = LightType::kPoint;
    scene.lights = {lamp, lamp};
    scene.lights[1].intensity = glm::vec3(3.0F);
    scene.environment.constant = glm::vec3(0.0F);
    return scene;
}

TEST(LightTables, ChooseEmittersByFlux) {
    const Scene scene = lit_scene();
    const LightTables tables = make_light_tables(scene, pose_scene(scene, 0), 1.0F);
    ASSERT_EQ(tables.emitters.size(), 2U);
    EXPECT_THAT(tables.first_emitter, testing::ElementsAre(0U, 1U));
    EXPECT_FLOAT_EQ(tables.emitters[0].probability, 0.2F); // the areas are 0.5 and 2 m²
    EXPECT_FLOAT_EQ(tables.emitters[1].probability, 0.8F);
    EXPECT_FLOAT_EQ(tables.emitters[1].area_m2, 2.0F);
}

TEST(LightTables, ChooseLightsByPower) {
    const Scene scene = lit_scene();
    const LightTables tables = make_light_tables(scene, pose_scene(scene, 0), 1.0F);
    EXPECT_THAT(tables.light_probability, testing::ElementsAre(testing::FloatEq(0.25F), testing::FloatEq(0.75F)));
}

TEST(LightTables, ProbabilitiesOfKindsAddUpToOne) {
    Scene scene = lit_scene();
    const ScenePose pose = pose_scene(scene, 0);
    for (const float sky : {0.0F, 1.0F}) {
        scene.environment.constant = glm::vec3(sky);
        const LightTables tables = make_light_tables(scene, pose, 1.0F);
        EXPECT_NEAR(tables.probability_emitter + tables.probability_environment + tables.probability_light, 1.0F,
                    1e-6F);
        EXPECT_EQ(tables.probability_environment > 0.0F, sky > 0.0F);
        EXPECT_GT(tables.probability_emitter, 0.0F);
        EXPECT_GT(tables.probability_light, 0.0F);
    }
}

TEST(LightTables, AreEmptyWithoutLight) {
    Scene scene = lit_scene();
    scene.materials[0].emissive_factor = glm::vec3(0.0F);
    scene.lights.clear();
    const LightTables tables = make_light_tables(scene, pose_scene(scene, 0), 1.0F);
    EXPECT_EQ(tables.probability_emitter + tables.probability_environment + tables.probability_light, 0.0F);
}

TEST(LightTables, CoverAllTexelsABilinearLookUpMixes) {
    Scene scene = lit_scene();
    scene.environment.width_px = 8;
    scene.environment.height_px = 4;
    scene.environment.pixels.assign(32, glm::vec3(0.0F));
    scene.environment.pixels[8 + 7] = glm::vec3(1.0F); // row 1, last column; its right neighbour is column 0
    const LightTables tables = make_light_tables(scene, pose_scene(scene, 0), 1.0F);
    float sum = 0.0F;
    for (std::size_t i = 0; i < 32; ++i) {
        const std::size_t row = i / 8;
        const std::size_t col = i % 8;
        EXPECT_EQ(tables.environment[i].probability > 0.0F, row <= 2 && (col >= 6 || col == 0)) << i;
        sum += tables.environment[i].probability;
    }
    EXPECT_NEAR(sum, 1.0F, 1e-6F);
}

TEST(GgxAlbedo, IsOneForASmoothMirrorAndNeverMore) {
    const auto table = make_ggx_albedo();
    for (std::size_t i = 0; i < table.size(); ++i) {
        EXPECT_LE(table[i].x + table[i].y, 1.0F + 1e-5F) << i; // rounding of sums of floats
        EXPECT_GT(table[i].x + table[i].y, 0.3F) << i;         // single scattering at full roughness loses half
    }
    EXPECT_NEAR(table[31].x + table[31].y, 1.0F, 1e-3F); // roughness 0 has no shadowing
}

} // namespace
} // namespace fieldcast::scene
