// SPDX-License-Identifier: Apache-2.0
#include "core/scene/acceleration.h"

#include "core/base/error.h"
#include "core/gpu/acceleration_structure.h"
#include "core/scene/bvh.h"
#include "shaders/shared/scene.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>

namespace fieldcast::scene {

namespace {

constexpr VkFormat kTexelFormat = VK_FORMAT_R32G32B32A32_UINT;
constexpr std::uint64_t kTexelBytes = 16;
static_assert(kMaxInstances <= 1U << shared::kRayQueryAlphaShift);

double ms_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// An array the kernels read through a texel buffer.
struct TexelArray {
    gpu::Buffer buffer;
    gpu::TexelView view;

    TexelArray() = default;
    TexelArray(const gpu::Device& device, std::span<const std::byte> bytes, const std::string& what) {
        const std::uint64_t limit = device.info().max_texel_buffer_elements;
        if (bytes.size() / kTexelBytes > limit) {
            throw UserError(what + " need " + std::to_string(bytes.size() / kTexelBytes) +
                            " texels, the device's limit (maxTexelBufferElements) is " + std::to_string(limit));
        }
        buffer = gpu::make_buffer(device, bytes);
        view = gpu::TexelView(device, buffer, kTexelFormat);
    }
};

template <class T> TexelArray texel_array(const gpu::Device& device, std::span<const T> values, std::string what) {
    static_assert(sizeof(T) % kTexelBytes == 0);
    return {device, std::as_bytes(values), what};
}

/// Our own BVH on the device.
struct DeviceBvh {
    Bvh bvh;
    TexelArray nodes;
    TexelArray triangles;
    TexelArray placed;

    DeviceBvh(const gpu::Device& device, const Scene& scene, const ScenePose& pose, bool share_meshes)
        : bvh(scene, pose, {share_meshes, {}}) {
        nodes = texel_array(device, std::span(bvh.nodes()), scene.name + ": BVH nodes");
        triangles = texel_array(device, std::span(bvh.triangles()), scene.name + ": triangles of the BVH");
        std::vector<shared::PlacedLevel> all(bvh.placement_count());
        std::copy(bvh.placed_levels().begin(), bvh.placed_levels().end(), all.begin());
        placed = texel_array(device, std::span<const shared::PlacedLevel>(all), scene.name + ": instances of the BVH");
    }

    void update(const gpu::Device& device, const ScenePose& pose) {
        if (!bvh.is_two_level()) {
            return;
        }
        bvh.place(pose);
        gpu::write_buffer(device, nodes.buffer, std::as_bytes(std::span(bvh.nodes()).first(bvh.top_capacity())));
        gpu::write_buffer(device, placed.buffer, std::as_bytes(std::span(bvh.placed_levels())));
    }

    std::uint64_t bytes() const {
        return nodes.buffer.size_bytes() + triangles.buffer.size_bytes() + placed.buffer.size_bytes();
    }
};

gpu::AccelerationStructure build_mesh(const gpu::Device& device, const Scene& scene, const Mesh& mesh) {
    const gpu::Buffer positions = gpu::make_buffer(device, std::span(mesh.positions));
    const gpu::Buffer indices = gpu::make_buffer(device, std::span(mesh.triangles));
    gpu::TriangleGeometry geometry;
    geometry.vertex_address = positions.address();
    geometry.vertex_stride_bytes = sizeof(glm::vec3);
    geometry.vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
    geometry.index_address = indices.address();
    geometry.triangle_count = static_cast<std::uint32_t>(mesh.triangles.size());
    geometry.is_opaque = scene.materials[mesh.material].alpha_mode == AlphaMode::kOpaque;
    return gpu::AccelerationStructure::bottom_level(device, geometry);
}

/// VK_KHR_acceleration_structure: one bottom level per mesh.
struct DeviceRayQuery {
    const Scene& scene;
    std::vector<gpu::AccelerationStructure> meshes;
    gpu::AccelerationStructure top;

    DeviceRayQuery(const gpu::Device& device, const Scene& the_scene, const ScenePose& pose) : scene(the_scene) {
        for (const Mesh& mesh : scene.meshes) {
            meshes.push_back(mesh.triangles.empty() ? gpu::AccelerationStructure() : build_mesh(device, scene, mesh));
        }
        top = gpu::AccelerationStructure::top_level(device, placed(pose));
    }

    std::vector<gpu::TopLevelInstance> placed(const ScenePose& pose) const {
        std::vector<gpu::TopLevelInstance> instances;
        for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
            const Instance& instance = scene.instances[i];
            const Material& material = scene.materials[scene.meshes[instance.mesh].material];
            if (!scene.meshes[instance.mesh].triangles.empty()) {
                const auto alpha_mode = static_cast<std::uint32_t>(material.alpha_mode);
                instances.push_back({pose.world_from_node[instance.node], i | alpha_mode << shared::kRayQueryAlphaShift,
                                     meshes[instance.mesh].address(), material.alpha_mode == AlphaMode::kOpaque, 0xFF});
            }
        }
        return instances;
    }

    void update(const gpu::Device& device, const ScenePose& pose) { top.rebuild(device, placed(pose)); }
};

bool any_alpha(const Scene& scene) {
    return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
        return scene.materials[scene.meshes[instance.mesh].material].alpha_mode != AlphaMode::kOpaque;
    });
}

AccelerationStatistics statistics_of(const DeviceBvh& own) {
    AccelerationStatistics statistics;
    statistics.bottom_levels = own.bvh.bottom_level_count();
    statistics.triangles = own.bvh.triangles().size();
    statistics.nodes = own.bvh.nodes().size();
    statistics.device_bytes = own.bytes();
    return statistics;
}

AccelerationStatistics statistics_of(const Scene& scene) {
    AccelerationStatistics statistics;
    statistics.bottom_levels = static_cast<std::uint32_t>(scene.meshes.size());
    for (const Mesh& mesh : scene.meshes) {
        statistics.triangles += mesh.triangles.size();
    }
    return statistics;
}

} // namespace

struct Acceleration::State {
    const gpu::Device& device;
    bool has_alpha = false;
    std::optional<DeviceBvh> own;
    std::optional<DeviceRayQuery> ray_query;
    AccelerationStatistics statistics;
};

Acceleration::Acceleration(const gpu::Device& device, const Scene& scene, const ScenePose& pose, Traversal traversal,
                           const AccelerationOptions& options)
    : state_(new State{device, any_alpha(scene), {}, {}, {}}) {
    const auto start = std::chrono::steady_clock::now();
    if (traversal == Traversal::kBvh) {
        state_->own.emplace(device, scene, pose, options.share_meshes);
        state_->statistics = statistics_of(*state_->own);
    } else {
        FC_ASSERT(device.info().has_ray_query, "the device has no ray query");
        state_->ray_query.emplace(device, scene, pose);
        state_->statistics = statistics_of(scene);
    }
    state_->statistics.build_ms = ms_since(start);
}

Acceleration::~Acceleration() = default;

void Acceleration::update(const ScenePose& pose) {
    const auto start = std::chrono::steady_clock::now();
    if (state_->own) {
        state_->own->update(state_->device, pose);
    } else {
        state_->ray_query->update(state_->device, pose);
    }
    state_->statistics.update_ms = ms_since(start);
}

void Acceleration::bind(gpu::BindingSet& set) const {
    if (state_->own) {
        set.set(shared::kBindNodes, state_->own->nodes.view);
        set.set(shared::kBindLeafTriangles, state_->own->triangles.view);
        set.set(shared::kBindTopLevel, state_->own->placed.view);
    } else {
        set.set(shared::kBindAcceleration, state_->ray_query->top);
    }
}

std::vector<gpu::Binding> Acceleration::bindings(Traversal traversal) {
    if (traversal == Traversal::kRayQuery) {
        return {{shared::kBindAcceleration, gpu::BindingType::kAccelerationStructure}};
    }
    return {{shared::kBindNodes}, {shared::kBindLeafTriangles}, {shared::kBindTopLevel}};
}

std::vector<gpu::Specialisation> Acceleration::specialisations() const {
    const bool is_two_level = state_->own && state_->own->bvh.is_two_level();
    return {{shared::kSpecialiseAlpha, state_->has_alpha ? 1U : 0U},
            {shared::kSpecialiseTwoLevel, is_two_level ? 1U : 0U}};
}

const AccelerationStatistics& Acceleration::statistics() const {
    return state_->statistics;
}

} // namespace fieldcast::scene
