// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/light_tables.h"
#include "core/scene/texture_arrays.h"

namespace fieldcast::scene {

/// The scene's geometry and materials as the arrays of shaders/shared/scene.h.
struct SceneRecords {
    std::vector<glm::uvec4> triangles;
    std::vector<shared::VertexRecord> vertices;
    std::vector<std::uint32_t> first_triangle; ///< per mesh
    std::vector<shared::MaterialRecord> materials;
    std::vector<shared::TextureUseRecord> texture_uses;
    glm::vec3 centre{0.0F}; ///< bounding sphere of the placed scene
    float radius_m = 1.0F;
};

SceneRecords make_scene_records(const Scene& scene, const ScenePose& pose, const TextureArrays& textures);

/// Instances with their transforms in `pose` and in `previous`.
std::vector<shared::InstanceRecord> make_instance_records(const Scene& scene, const SceneRecords& records,
                                                          const LightTables& lights, const ScenePose& pose,
                                                          const ScenePose& previous);

} // namespace fieldcast::scene
