// SPDX-License-Identifier: Apache-2.0
// An input is a .glb or .gltf file. What it refers to must lie in it: there is nothing beside it.
#include "core/scene/gltf/loader.h"

#include "core/base/error.h"
#include "core/scene/light_tables.h"
#include "tests/fuzz/input.h"

#include <algorithm>
#include <limits>

namespace fieldcast::fuzz {

namespace {

scene::LoadOptions small_limits() {
    scene::LoadOptions options;
    options.limits.max_triangles = 1U << 16;
    options.limits.max_image_pixels = 1U << 16;
    options.limits.max_total_image_pixels = 1U << 18;
    options.limits.max_file_bytes = 1U << 22;
    return options;
}

void expect_sound(const scene::Scene& scene) {
    for (const scene::Mesh& mesh : scene.meshes) {
        const auto count = static_cast<std::uint32_t>(mesh.positions.size());
        for (const glm::uvec3& triangle : mesh.triangles) {
            FC_ASSERT(glm::all(glm::lessThan(triangle, glm::uvec3(count))), "triangles name vertices");
        }
        FC_ASSERT(mesh.normals.size() == count && mesh.material < scene.materials.size(), "meshes are complete");
    }
    for (const scene::Texture& texture : scene.textures) {
        FC_ASSERT(texture.image < scene.images.size(), "textures name images");
    }
}

/// What a client does with a scene before it goes to a device; `time_ns` is the server's.
void use(const scene::Scene& scene, std::int64_t time_ns) {
    const scene::ScenePose pose = scene::pose_scene(scene, time_ns);
    static_cast<void>(scene::loop_index(scene, time_ns));
    if (const scene::CameraNode* const camera = scene::find_camera(scene)) {
        static_cast<void>(scene::camera_pose(pose, *camera));
    }
    const scene::LightTables tables = scene::make_light_tables(scene, pose, 1.0F);
    static_cast<void>(scene::make_light_records(scene, pose, tables.light_probability));
}

} // namespace

void gltf(Bytes input) {
    const std::string_view text = as_text(input.first(std::min<std::size_t>(input.size(), 4)));
    const auto file = scratch_file(text == "glTF" ? "input.glb" : "input.gltf", input);
    is_refused([&] {
        const scene::Scene scene = scene::load_scene(file, small_limits());
        expect_sound(scene);
        constexpr auto kTimeRange = std::numeric_limits<std::int64_t>();
        for (const std::int64_t time_ns :
             {std::int64_t{0}, std::int64_t{370'000'000}, kTimeRange.min(), kTimeRange.max()}) {
            use(scene, time_ns);
        }
    });
}

} // namespace fieldcast::fuzz
