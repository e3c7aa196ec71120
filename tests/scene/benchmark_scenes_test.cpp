// SPDX-License-Identifier: Apache-2.0
#include "core/scene/bundle.h"
#include "core/scene/gltf/loader.h"

#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>

namespace fieldcast::scene {
namespace {

namespace fs = std::filesystem;

struct KnownScene {
    const char* name;
    const char* file;
    std::uint64_t triangles; ///< instanced; 0: not compared
    std::uint64_t instances; ///< 0: not compared
    std::size_t warnings = 0;
};

std::ostream& operator<<(std::ostream& stream, const KnownScene& scene) {
    return stream << scene.name;
}

class KnownSceneTest : public testing::TestWithParam<KnownScene> {};

TEST_P(KnownSceneTest, LoadsWithTheKnownCounts) {
    const KnownScene& known = GetParam();
    if (!fs::exists(known.file)) {
        ASSERT_TRUE(std::string(known.file).starts_with("../")) << known.file << " must exist in the project";
        GTEST_SKIP() << known.file << " is not on this machine";
    }
    const Scene scene = load_scene(known.file);
    std::uint64_t triangles = 0;
    for (const Instance& instance : scene.instances) {
        triangles += scene.meshes.at(instance.mesh).triangles.size();
    }
    EXPECT_EQ(triangles, known.triangles == 0 ? triangles : known.triangles);
    EXPECT_EQ(scene.instances.size(), known.instances == 0 ? scene.instances.size() : known.instances);
    EXPECT_EQ(scene.warnings.size(), known.warnings);
    EXPECT_EQ(scene.lights.size(), 1U);
    ASSERT_NE(find_camera(scene, "LightField"), nullptr);
    EXPECT_NEAR(scene.duration_s, 29.0 / 30.0, 1e-6);
    const CameraNode& camera = *find_camera(scene);
    EXPECT_TRUE(scene.nodes.at(camera.node).is_animated);
    EXPECT_NEAR(camera.fovy_rad, 0.785398F, 1e-5F);
    EXPECT_NE(camera_pose(pose_scene(scene, 0), camera), camera_pose(pose_scene(scene, 500'000'000), camera));
    EXPECT_EQ(hash_bundle(make_bundle(known.file, {})), scene.hash);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, KnownSceneTest,
    testing::Values(KnownScene{"Sponza", "../shared/scenes/sponza/Sponza.gltf", 262'087, 170},
                    KnownScene{"BreakfastRoom", "../shared/scenes/breakfast_room/BreakfastRoom.gltf", 262'687, 0},
                    KnownScene{"GasStation", "../shared/scenes/gas_station/GasStation.gltf", 99'002, 1'102},
                    KnownScene{"Atelier", "scenes/atelier/atelier.gltf", 117'368, 180}),
    [](const auto& test) { return std::string(test.param.name); });

} // namespace
} // namespace fieldcast::scene
