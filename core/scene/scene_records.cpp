// SPDX-License-Identifier: Apache-2.0
#include "core/scene/scene_records.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

namespace fieldcast::scene {

namespace {

/// Packs a normal as octahedral snorm 2x16, as in lib/packing.glsl.
std::uint32_t pack_normal(const glm::vec3& n) {
    glm::vec2 p = glm::vec2(n) / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
    if (n.z < 0.0F) {
        p = (1.0F - glm::abs(glm::vec2(p.y, p.x))) * glm::vec2(p.x >= 0.0F ? 1.0F : -1.0F, p.y >= 0.0F ? 1.0F : -1.0F);
    }
    return glm::packSnorm2x16(p);
}

shared::VertexRecord make_vertex(const Mesh& mesh, std::size_t i) {
    shared::VertexRecord record{};
    record.position = mesh.positions[i];
    record.normal = pack_normal(mesh.normals[i]);
    record.uv0 = mesh.uv0.empty() ? glm::vec2(0.0F) : mesh.uv0[i];
    record.uv1 = mesh.uv1.empty() ? record.uv0 : mesh.uv1[i];
    record.tangent = mesh.tangents.empty() ? shared::kNoIndex : pack_normal(glm::vec3(mesh.tangents[i]));
    record.tangent_sign = mesh.tangents.empty() ? 1.0F : mesh.tangents[i].w;
    record.colour = mesh.colours.empty() ? 0xFFFFFFFFU : glm::packUnorm4x8(mesh.colours[i]);
    return record;
}

void append_mesh(const Mesh& mesh, SceneRecords& records) {
    const auto first_vertex = static_cast<std::uint32_t>(records.vertices.size());
    records.first_triangle.push_back(static_cast<std::uint32_t>(records.triangles.size()));
    for (const glm::uvec3& triangle : mesh.triangles) {
        records.triangles.emplace_back(triangle + first_vertex, 0U);
    }
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        records.vertices.push_back(make_vertex(mesh, i));
    }
}

std::uint32_t append_use(const Scene& scene, const TextureArrays& textures, const TextureUse& use, bool srgb,
                         SceneRecords& records) {
    if (use.texture == kNone) {
        return shared::kNoIndex;
    }
    const Texture& texture = scene.textures[use.texture];
    const TexturePlace place = textures.place(use.texture, srgb);
    shared::TextureUseRecord record{};
    record.u_row = use.uv_matrix[0];
    record.v_row = use.uv_matrix[1];
    record.place = place.array | place.layer << 4 | static_cast<std::uint32_t>(texture.wrap_u) << 20 |
                   static_cast<std::uint32_t>(texture.wrap_v) << 22 | use.uv_set << 24;
    record.size_px = static_cast<float>(place.side_px);
    records.texture_uses.push_back(record);
    return static_cast<std::uint32_t>(records.texture_uses.size() - 1);
}

shared::MaterialRecord make_material(const Scene& scene, const TextureArrays& textures, const Material& material,
                                     SceneRecords& records) {
    shared::MaterialRecord record{};
    record.base_colour = material.base_colour_factor;
    record.emission = material.emissive_factor;
    record.alpha_cutoff = material.alpha_cutoff;
    record.metallic = material.metallic_factor;
    record.roughness = material.roughness_factor;
    record.normal_scale = material.normal_scale;
    record.ior = material.ior;
    record.transmission = material.transmission_factor;
    const bool emits = std::max({record.emission.x, record.emission.y, record.emission.z}) > 0.0F;
    record.flags = static_cast<std::uint32_t>(material.alpha_mode) |
                   (material.double_sided ? shared::kMaterialDoubleSided : 0U) |
                   (emits ? shared::kMaterialEmissive : 0U);
    record.base_colour_use = append_use(scene, textures, material.base_colour, true, records);
    record.metallic_roughness_use = append_use(scene, textures, material.metallic_roughness, false, records);
    record.normal_use = append_use(scene, textures, material.normal, false, records);
    record.emission_use = append_use(scene, textures, material.emissive, true, records);
    record.transmission_use = append_use(scene, textures, material.transmission, false, records);
    return record;
}

/// Sets the sphere around the box of all placed vertices.
void bound_scene(const Scene& scene, const ScenePose& pose, SceneRecords& records) {
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(-std::numeric_limits<float>::max());
    for (const Instance& instance : scene.instances) {
        const glm::mat4& world_from_object = pose.world_from_node[instance.node];
        for (const glm::vec3& p : scene.meshes[instance.mesh].positions) {
            const glm::vec3 world(world_from_object * glm::vec4(p, 1.0F));
            low = glm::min(low, world);
            high = glm::max(high, world);
        }
    }
    if (low.x <= high.x) {
        records.centre = 0.5F * (low + high);
        records.radius_m = std::max(0.5F * glm::length(high - low), 1e-3F);
    }
}

void store_rows(const glm::mat4& m, glm::vec4* rows) {
    for (int row = 0; row < 3; ++row) {
        rows[row] = glm::vec4(m[0][row], m[1][row], m[2][row], m[3][row]);
    }
}

} // namespace

SceneRecords make_scene_records(const Scene& scene, const ScenePose& pose, const TextureArrays& textures) {
    SceneRecords records;
    for (const Mesh& mesh : scene.meshes) {
        append_mesh(mesh, records);
    }
    for (const Material& material : scene.materials) {
        records.materials.push_back(make_material(scene, textures, material, records));
    }
    bound_scene(scene, pose, records);
    return records;
}

std::vector<shared::InstanceRecord> make_instance_records(const Scene& scene, const SceneRecords& records,
                                                          const LightTables& lights, const ScenePose& pose,
                                                          const ScenePose& previous) {
    std::vector<shared::InstanceRecord> out(scene.instances.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const glm::mat4& world_from_object = pose.world_from_node[instance.node];
        store_rows(world_from_object, out[i].world_from_object);
        store_rows(previous.world_from_node[instance.node], out[i].previous_world_from_object);
        out[i].first_triangle = records.first_triangle[instance.mesh];
        out[i].material = scene.meshes[instance.mesh].material;
        out[i].first_emitter = lights.first_emitter[i];
        out[i].flags = glm::determinant(glm::mat3(world_from_object)) < 0.0F ? shared::kInstanceMirrored : 0U;
    }
    return out;
}

} // namespace fieldcast::scene
