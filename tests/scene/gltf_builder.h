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

/// Component types and modes of glTF.
enum : int { kI8 = 5120, kU8 = 5121, kI16 = 5122, kU16 = 5123, kU32 = 5125, kF32 = 5126 };
enum : int { kPoints = 0, kTriangles = 4, kStrip = 5, kFan = 6 };

/// Makes small glTF files. `json` is the document and may be changed freely before writing.
class GltfBuilder {
public:
    GltfBuilder();

    nlohmann::json json;
    std::vector<std::byte> binary;

    /// Appends to a top-level list and returns the index.
    int add(const char* list, nlohmann::json entry);
    int add_view(std::span<const std::byte> bytes, int stride = 0);
    /// An accessor over a view of its own.
    template <class T>
    int add_accessor(const std::vector<T>& values, const char* type, int component_type, bool is_normalised = false) {
        return add_accessor(std::as_bytes(std::span(values)), values.size(), type, component_type, is_normalised);
    }
    int add_floats(const std::vector<float>& values, const char* type) { return add_accessor(values, type, kF32); }
    int add_accessor(std::span<const std::byte> bytes, std::size_t value_count, const char* type, int component_type,
                     bool is_normalised);
    /// A 2 × 1 PNG in a buffer view and a texture of it; returns the texture.
    int add_texture();
    /// A node of the scene.
    int add_node(nlohmann::json node);
    /// Mesh with one primitive; returns the mesh.
    int add_mesh(nlohmann::json primitive);
    /// A mesh of one triangle in the plane z = 0 with normals +Z, shown by a node; returns the mesh.
    int add_triangle();

    /// JSON with the buffer as data URI.
    std::string gltf() const;
    std::vector<std::byte> glb() const;
    /// Writes and loads it as .gltf.
    Scene load(const LoadOptions& options = {}) const;
};

/// What load_scene says about a file it must refuse; a message of its own if it does not.
std::string refusal(const std::filesystem::path& file, const LoadOptions& options = {});
std::string refusal(const GltfBuilder& builder, const LoadOptions& options = {});

std::string base64(std::span<const std::byte> bytes);
/// A PNG of `width` × `height` pixels.
std::vector<std::byte> small_png(std::uint32_t width, std::uint32_t height);

} // namespace fieldcast::scene
