// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/gltf/document.h"
#include "core/scene/scene.h"

#include <cstdint>
#include <vector>

namespace fieldcast::scene {

/// The nodes of the default scene, parents first.
struct GltfNodes {
    std::vector<Node> nodes;
    std::vector<int> file_index;            ///< per node: its index in the file
    std::vector<std::uint32_t> scene_index; ///< per node of the file: its index in `nodes`; kNone: not in the scene
};

/// Reads the node graph. Throws UserError for cycles, nodes with two parents and scenes whose root has a parent.
GltfNodes read_nodes(const GltfDocument& document);

/// The file's entry of a scene node, which holds its name, mesh, camera and light.
inline const tinygltf::Node& file_node(const GltfDocument& document, const GltfNodes& nodes, std::size_t node) {
    return document.model.nodes[static_cast<std::size_t>(nodes.file_index[node])];
}
std::string node_name(const GltfDocument& document, int file_index);

} // namespace fieldcast::scene
