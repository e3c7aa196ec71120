// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/gltf/accessors.h"
#include "core/scene/gltf/nodes.h"

#include <vector>

namespace fieldcast::scene {

struct GltfMeshes {
    std::vector<Mesh> meshes;        ///< one per primitive that some node shows
    std::vector<Instance> instances; ///< in the order of nodes, then of primitives
};

/// Throws UserError, before allocating, when a limit is exceeded.
GltfMeshes read_meshes(GltfDocument& document, GltfAccessors& accessors, const GltfNodes& nodes,
                       const SceneLimits& limits);

} // namespace fieldcast::scene
