// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

namespace fieldcast::scene {

/// The JSON of a .gltf or .glb file and the binary chunk of the latter.
struct GltfJson {
    nlohmann::json root;
    std::span<const std::byte> binary; ///< part of the bytes given to parse_gltf_json(); empty: no chunk
};

/// Parses the file and makes all checks that do not need its buffers: container, depth, types and ranges of all known
/// properties, version, required extensions. Messages name `file`. Throws UserError.
///
/// tinygltf reads properties of a wrong type as absent and truncates large integers, so these checks come first.
GltfJson parse_gltf_json(std::span<const std::byte> bytes, const std::string& file);

/// Whether the loader implements the extension.
bool is_supported_extension(std::string_view name);

/// Throws UserError unless every known property below `root` has the right type and range.
void check_gltf_properties(const nlohmann::json& root, const std::string& file);

} // namespace fieldcast::scene
