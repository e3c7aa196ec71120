// SPDX-License-Identifier: Apache-2.0
#include "core/scene/gpu_scene.h"

#include "core/base/error.h"
#include "core/scene/acceleration.h"
#include "core/scene/bvh.h"
#include "core/scene/ggx_albedo.h"
#include "core/scene/scene_records.h"

#include <algorithm>

namespace fieldcast::scene {

namespace {

std::vector<gpu::Binding> scene_bindings(Traversal traversal) {
    std::vector<gpu::Binding> bindings = Acceleration::bindings(traversal);
    for (const std::uint32_t texels :
         {shared::kBindInstances, shared::kBindTriangles, shared::kBindVertices, shared::kBindMaterials,
          shared::kBindTextureUses, shared::kBindLights, shared::kBindEmitters, shared::kBindEnvironmentAlias,
          shared::kBindSceneInfo, shared::kBindGgxAlbedo}) {
        bindings.push_back({texels, gpu::BindingType::kTexelBuffer, 1});
    }
    bindings.push_back({shared::kBindEnvironment, gpu::BindingType::kTexture, 1});
    bindings.push_back({shared::kBindTextures, gpu::BindingType::kTexture, shared::kTextureArrays});
    return bindings;
}

gpu::Texture make_environment(const gpu::Device& device, const Environment& environment) {
    std::vector<glm::vec4> texels{glm::vec4(environment.constant, 1.0F)};
    gpu::TextureDesc desc;
    desc.format = VK_FORMAT_R32G32B32A32_SFLOAT;
    desc.mip_maps = false;
    if (!environment.pixels.empty()) {
        texels.clear();
        for (const glm::vec3& pixel : environment.pixels) {
            texels.emplace_back(pixel, 1.0F);
        }
        desc.width_px = environment.width_px;
        desc.height_px = environment.height_px;
    }
    const auto bytes = std::as_bytes(std::span(texels));
    return {device, desc, std::span(&bytes, 1)};
}

/// A texel buffer and what keeps it alive.
struct TexelArray {
    gpu::Buffer buffer;
    gpu::TexelView view;
};

template <class T> TexelArray make_texels(const gpu::Device& device, const std::vector<T>& values, VkFormat format) {
    TexelArray array;
    array.buffer = gpu::make_buffer(device, std::span(values.data(), values.size()));
    array.view = gpu::TexelView(device, array.buffer, format);
    return array;
}

bool uses_glossy(const Scene& scene) {
    return std::ranges::any_of(scene.instances, [&](const Instance& instance) {
        const Material& material = scene.materials[scene.meshes[instance.mesh].material];
        return material.roughness_factor < shared::kGlossyRoughness || material.metallic_roughness.texture != kNone;
    });
}

bool uses_blend(const Scene& scene) {
    return std::ranges::any_of(scene.instances, [&](const Instance& instance) {
        return scene.materials[scene.meshes[instance.mesh].material].alpha_mode == AlphaMode::kBlend;
    });
}

} // namespace

struct GpuScene::State {
    State(const gpu::Device& d, const Scene& s, Traversal t)
        : device(d), scene(s), traversal(t), pose(pose_scene(s, 0)), textures(d, s),
          records(make_scene_records(s, pose, textures)), lights(make_light_tables(s, pose, records.radius_m)),
          acceleration(d, s, pose, t), layout(d, scene_bindings(t)), bindings(d, layout), has_blend(uses_blend(s)),
          has_glossy(uses_glossy(s)) {}

    void upload_static();
    void upload_lights();
    void upload_instances(const ScenePose& previous);
    void bind(std::uint32_t binding, TexelArray array);

    const gpu::Device& device;
    const Scene& scene;
    Traversal traversal;
    ScenePose pose;
    std::uint64_t pose_count = 0;
    TextureArrays textures;
    SceneRecords records;
    LightTables lights;
    Acceleration acceleration;
    gpu::BindingLayout layout;
    gpu::BindingSet bindings;
    bool has_blend;
    bool has_glossy;
    gpu::Texture environment;
    VisibilityMethod visibility = VisibilityMethod::kRays;
    std::optional<DrawGeometry> drawn;
    std::array<TexelArray, 16> arrays; ///< by binding
};

void GpuScene::State::bind(std::uint32_t binding, TexelArray array) {
    bindings.set(binding, array.view);
    arrays[binding] = std::move(array);
}

void GpuScene::State::upload_static() {
    constexpr VkFormat kFloats = VK_FORMAT_R32G32B32A32_SFLOAT;
    bind(shared::kBindTriangles, make_texels(device, records.triangles, VK_FORMAT_R32G32B32A32_UINT));
    bind(shared::kBindVertices, make_texels(device, records.vertices, kFloats));
    bind(shared::kBindMaterials, make_texels(device, records.materials, kFloats));
    bind(shared::kBindTextureUses, make_texels(device, records.texture_uses, kFloats));
    bind(shared::kBindEmitters, make_texels(device, lights.emitters, kFloats));
    bind(shared::kBindEnvironmentAlias, make_texels(device, lights.environment, kFloats));
    bind(shared::kBindGgxAlbedo, make_texels(device, make_ggx_albedo(), kFloats));
    bind(shared::kBindLights,
         make_texels(device, make_light_records(scene, pose, lights.light_probability), kFloats));
    shared::SceneInfo info{};
    info.sky = scene.environment.constant;
    info.environment_width = scene.environment.width_px;
    info.environment_height = scene.environment.height_px;
    info.light_count = static_cast<std::uint32_t>(scene.lights.size());
    info.emitter_count = static_cast<std::uint32_t>(lights.emitters.size());
    info.instance_count = static_cast<std::uint32_t>(scene.instances.size());
    info.probability_environment = lights.probability_environment;
    info.probability_emitter = lights.probability_emitter;
    info.probability_light = lights.probability_light;
    info.has_blend = has_blend ? 1 : 0;
    info.centre = records.centre;
    info.radius_m = records.radius_m;
    bind(shared::kBindSceneInfo, make_texels(device, std::vector{info}, kFloats));
    environment = make_environment(device, scene.environment);
    bindings.set(shared::kBindEnvironment, environment);
    for (std::uint32_t array = 0; array < shared::kTextureArrays; ++array) {
        bindings.set(shared::kBindTextures, textures.array(array), array);
    }
    acceleration.bind(bindings);
}

void GpuScene::State::upload_lights() {
    const auto values = make_light_records(scene, pose, lights.light_probability);
    if (!values.empty()) {
        gpu::write_buffer(device, arrays[shared::kBindLights].buffer, std::as_bytes(std::span(values)));
    }
}

void GpuScene::State::upload_instances(const ScenePose& previous) {
    const auto values = make_instance_records(scene, records, lights, pose, previous);
    if (!arrays[shared::kBindInstances].buffer) {
        bind(shared::kBindInstances, make_texels(device, values, VK_FORMAT_R32G32B32A32_SFLOAT));
    } else if (!values.empty()) {
        gpu::write_buffer(device, arrays[shared::kBindInstances].buffer, std::as_bytes(std::span(values)));
    }
}

GpuScene::GpuScene(const gpu::Device& device, const Scene& scene, Traversal traversal)
    : GpuScene(device, scene, traversal, choose_visibility(device, "auto")) {}

GpuScene::GpuScene(const gpu::Device& device, const Scene& scene, Traversal traversal, VisibilityMethod visibility)
    : state_(std::make_unique<State>(device, scene, traversal)) {
    state_->upload_static();
    state_->upload_instances(state_->pose);
    // Drawing flattens instances; where they share their meshes to save memory, that is lost.
    const bool is_too_much = visibility == VisibilityMethod::kFaster && should_share_meshes(scene);
    state_->visibility = is_too_much ? VisibilityMethod::kRays : visibility;
    if (state_->visibility != VisibilityMethod::kRays) {
        state_->drawn.emplace(device, scene, state_->pose);
    }
}

GpuScene::~GpuScene() = default;

void GpuScene::pose(std::int64_t time_ns, bool cut) {
    ++state_->pose_count;
    ScenePose next = pose_scene(state_->scene, time_ns);
    const bool moves = !state_->scene.channels.empty();
    std::swap(state_->pose, next); // `next` is now the pose before
    if (!moves) {
        return;
    }
    state_->upload_instances(cut ? state_->pose : next);
    state_->upload_lights();
    state_->acceleration.update(state_->pose);
}

std::uint64_t GpuScene::pose_count() const {
    return state_->pose_count;
}

const ScenePose& GpuScene::current_pose() const {
    return state_->pose;
}
const Scene& GpuScene::scene() const {
    return state_->scene;
}
Traversal GpuScene::traversal() const {
    return state_->traversal;
}
float GpuScene::radius_m() const {
    return state_->records.radius_m;
}
VisibilityMethod GpuScene::visibility() const {
    return state_->visibility;
}
const DrawGeometry* GpuScene::draw_geometry() const {
    return state_->drawn ? &*state_->drawn : nullptr;
}
const gpu::BindingLayout& GpuScene::layout() const {
    return state_->layout;
}
const gpu::BindingSet& GpuScene::bindings() const {
    return state_->bindings;
}
bool GpuScene::has_blend() const {
    return state_->has_blend;
}
bool GpuScene::has_glossy() const {
    return state_->has_glossy;
}

std::vector<gpu::Specialisation> GpuScene::specialisations() const {
    std::vector<gpu::Specialisation> values = state_->acceleration.specialisations();
    values.push_back({shared::kSpecialiseTextureArrays, state_->textures.used_mask()});
    values.push_back({shared::kSpecialiseBlend, state_->has_blend ? 1U : 0U});
    return values;
}

std::uint64_t GpuScene::device_bytes() const {
    std::uint64_t bytes = state_->textures.device_bytes() + state_->acceleration.statistics().device_bytes;
    for (const TexelArray& array : state_->arrays) {
        bytes += array.buffer.size_bytes();
    }
    if (state_->drawn) {
        bytes += state_->drawn->device_bytes();
    }
    return bytes;
}

} // namespace fieldcast::scene
