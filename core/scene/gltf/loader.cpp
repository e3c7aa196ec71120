// SPDX-License-Identifier: Apache-2.0
#include "core/scene/gltf/loader.h"

#include "core/base/error.h"
#include "core/scene/bundle.h"
#include "core/scene/environment.h"
#include "core/scene/gltf/animations.h"
#include "core/scene/gltf/images.h"
#include "core/scene/gltf/lights.h"
#include "core/scene/gltf/materials.h"
#include "core/scene/gltf/meshes.h"
#include "core/scene/scene_extent.h"
#include "core/scene/studio.h"

#include <algorithm>
#include <new>

namespace fieldcast::scene {

namespace {

double longest_animation_s(const std::vector<AnimationChannel>& channels) {
    double duration_s = 0.0;
    for (const AnimationChannel& channel : channels) {
        duration_s = std::max(duration_s, static_cast<double>(channel.times_s.back()));
    }
    return duration_s;
}

bool wants_studio(const Scene& scene, const LoadOptions& options) {
    if (options.environment) {
        return false;
    }
    switch (options.surroundings) {
    case Surroundings::kSky:
        return false;
    case Surroundings::kStudio:
        return true;
    case Surroundings::kStudioIfUnlit:
        return !has_light(scene);
    }
    return false;
}

Scene load(const std::filesystem::path& file, const LoadOptions& options) {
    GltfDocument document = read_gltf_document(file, options);
    GltfBufferViews views(document, options.limits.max_file_bytes);
    GltfAccessors accessors(document, views);
    GltfNodes nodes = read_nodes(document);
    GltfSurfaces surfaces = read_surfaces(document);
    GltfMeshes meshes = read_meshes(document, views, accessors, nodes, options.limits);

    Scene scene;
    scene.name = document.name;
    scene.channels = read_animations(document, accessors, nodes);
    scene.duration_s = longest_animation_s(scene.channels);
    scene.lights = read_lights(document, nodes);
    scene.cameras = read_cameras(document, nodes);
    scene.nodes = std::move(nodes.nodes);
    scene.meshes = std::move(meshes.meshes);
    scene.instances = std::move(meshes.instances);
    check_extent(scene);
    scene.images = decode_images(document, views, options.limits, surfaces.textures);
    scene.textures = std::move(surfaces.textures);
    scene.materials = std::move(surfaces.materials);
    scene.warnings = document.warnings.lines();
    scene.has_studio = wants_studio(scene, options);
    if (scene.has_studio) {
        add_studio(document.files);
        scene.environment = studio_environment();
    } else {
        scene.environment = read_environment(options);
    }
    scene.hash = hash_files(document.files, options);
    return scene;
}

} // namespace

Scene load_scene(const std::filesystem::path& file, const LoadOptions& options) {
    try {
        return load(file, options);
    } catch (const std::bad_alloc&) {
        refuse(file.filename().string(), "file",
               "does not fit in memory; use a simpler scene or a machine with more memory");
    }
}

} // namespace fieldcast::scene
