// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/gltf/accessors.h"
#include "core/scene/gltf/nodes.h"

#include <vector>

namespace fieldcast::scene {

struct GltfMeshes {
    std::vector<Mesh> meshes;        ///< one per primitive that at least one node shows
    std::vector<Instance> instances; ///< ordered by node, then by primitive
};

/// Reads the meshes that nodes show, and their instances. Throws UserError, before allocating if a limit is exceeded.
GltfMeshes read_meshes(GltfDocument& document, GltfBufferViews& views, GltfAccessors& accessors, const GltfNodes& nodes,
                       const SceneLimits& limits);

} // namespace fieldcast::scene
