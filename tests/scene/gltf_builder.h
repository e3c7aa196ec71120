// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/gltf/loader.h"

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace fieldcast::scene {

/// A folder below the system's temporary one, removed with everything in it.
class TempFolder {
public:
    TempFolder();
    ~TempFolder();
    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path write(const std::string& name, std::span<const std::byte> bytes) const;
    std::filesystem::path write(const std::string& name, const std::string& text) const;

private:
    std::filesystem::path path_;
};

/// Component types of glTF accessors.
enum : int { kI8 = 5120, kU8 = 5121, kI16 = 5122, kU16 = 5123, kU32 = 5125, kF32 = 5126 };
enum : int { kPoints = 0, kTriangles = 4, kStrip = 5, kFan = 6 };

/// Makes small glTF files. `json` is the document, which tests may change before it is written.
class GltfBuilder {
public:
    GltfBuilder();

    nlohmann::json json;
    std::vector<std::byte> binary;

    /// Appends to a top-level list and returns the index.
    int add(const char* list, nlohmann::json entry);
    int add_view(std::span<const std::byte> bytes, int stride = 0);
    /// Adds an accessor with its own view.
    template <class T>
    int add_accessor(const std::vector<T>& values, const char* type, int component_type, bool is_normalised = false) {
        return add_accessor(std::as_bytes(std::span(values)), values.size(), type, component_type, is_normalised);
    }
    int add_floats(const std::vector<float>& values, const char* type) { return add_accessor(values, type, kF32); }
    int add_accessor(std::span<const std::byte> bytes, std::size_t value_count, const char* type, int component_type,
                     bool is_normalised);
    /// Adds a 2 × 1 PNG in a buffer view and a texture of it; returns the texture.
    int add_texture();
    /// Adds a node to the scene; returns the node.
    int add_node(nlohmann::json node);
    /// Adds a mesh with one primitive; returns the mesh.
    int add_mesh(nlohmann::json primitive);
    /// Adds a mesh of one triangle in the plane z = 0 with normals +Z, and a node that shows it; returns the mesh.
    int add_triangle();

    /// The document as text, with the buffer as data URI.
    std::string gltf() const;
    std::vector<std::byte> glb() const;
    /// Writes the document as .gltf and loads it.
    Scene load(const LoadOptions& options = {}) const;
};

/// The message with which load_scene refuses a file; "(the file was accepted)" if it does not.
std::string refusal(const std::filesystem::path& file, const LoadOptions& options = {});
std::string refusal(const GltfBuilder& builder, const LoadOptions& options = {});

std::string base64(std::span<const std::byte> bytes);
/// A PNG of `width` × `height` pixels.
std::vector<std::byte> small_png(std::uint32_t width, std::uint32_t height);

} // namespace fieldcast::scene
