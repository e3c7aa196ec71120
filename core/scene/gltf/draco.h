// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/gltf/accessors.h"

#include <cstdint>
#include <map>
#include <vector>

namespace fieldcast::scene {

inline constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

/// A decoded primitive.
struct DracoPrimitive {
    std::vector<std::uint32_t> corners;              ///< vertices, three per triangle; not checked
    std::map<int, std::vector<std::byte>> accessors; ///< packed elements, in the component type of each accessor
};

/// Whether the primitive's geometry is compressed with KHR_draco_mesh_compression.
bool is_draco(const tinygltf::Primitive& primitive);

/// Decodes the geometry of a primitive with KHR_draco_mesh_compression. The result counts towards the limit on
/// decompressed bytes. `object` names the primitive. Throws UserError if the data is broken, differs from the
/// primitive's accessors, or has more than `max_triangles` triangles.
DracoPrimitive read_draco(const GltfDocument& document, GltfBufferViews& views, const tinygltf::Primitive& primitive,
                          std::uint64_t max_triangles, const std::string& object);

} // namespace fieldcast::scene
