// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/gltf/json.h"
#include "core/scene/load_report.h"
#include "core/scene/scene_files.h"

#include <cstddef>
#include <span>
#include <string>
#include <tiny_gltf.h>
#include <vector>

namespace fieldcast::scene {

/// A buffer of the file.
struct GltfBuffer {
    std::uint64_t byte_length = 0;
    std::span<const std::byte> bytes;  ///< empty: a fallback buffer of EXT_meshopt_compression, never read
    std::vector<std::byte> data_bytes; ///< owns `bytes` if they come from a data URI
};

/// A compressed image of the file.
struct GltfImage {
    std::string name;                  ///< "image 3 'bricks.jpg'"
    int buffer_view = -1;              ///< view of the compressed image; −1: it is in `bytes`
    std::span<const std::byte> bytes;  ///< compressed
    std::vector<std::byte> data_bytes; ///< as in GltfBuffer
};

/// A parsed glTF file with the bytes it refers to. All indices are valid, all accessors lie within their buffer views.
/// `model` has no buffers, images and skins, because tinygltf would read those without any check.
struct GltfDocument {
    std::string name; ///< file name, for messages
    SceneFiles files;
    tinygltf::Model model;
    std::vector<GltfBuffer> buffers;
    std::vector<GltfImage> images;
    std::size_t skin_count = 0;
    LoadWarnings warnings;

    [[noreturn]] void refuse(const std::string& object, const std::string& reason) const {
        scene::refuse(name, object, reason);
    }
};

/// Reads a .gltf or .glb file and everything it refers to, without decoding images. Throws UserError.
GltfDocument read_gltf_document(const std::filesystem::path& file, const LoadOptions& options);

/// Reads the same files without parsing the model, for callers that need only the bytes. Throws UserError.
SceneFiles read_scene_files(const std::filesystem::path& file, const LoadOptions& options);

/// Throws UserError unless every index and every range in the document is valid.
void check_gltf_references(const GltfDocument& document);

/// Size in bytes of one accessor component; nothing for types that glTF does not allow.
std::optional<std::uint64_t> component_bytes(int component_type);

} // namespace fieldcast::scene
