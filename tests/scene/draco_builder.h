// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/scene/gltf_builder.h"

#include <draco/core/encoder_buffer.h>
#include <draco/mesh/mesh.h>
#include <memory>

namespace fieldcast::scene {

inline constexpr const char* kDraco = "KHR_draco_mesh_compression";
inline constexpr int kFirstId = 7; ///< unique id of the first attribute; the others follow in the order of Corner

/// One corner of a triangle.
struct Corner {
    glm::vec3 position{0.0F};
    glm::vec3 normal{0.0F};
    glm::vec2 uv{0.0F};
    glm::u8vec4 colour{0};
    glm::vec4 tangent{0.0F};
};

/// Three corners per triangle.
using Corners = std::vector<Corner>;

/// A wavy sheet of `size` × `size` cells, each of two triangles. Normals, texture coordinates and colours differ
/// between its halves, so the middle line is a seam.
Corners draco_sheet(int size = 8);

/// A mesh that encoders accept.
std::unique_ptr<draco::Mesh> draco_mesh(const Corners& corners);

std::vector<std::byte> bytes_of(const draco::EncoderBuffer& buffer);

/// Compressed data and its counts.
struct DracoData {
    std::vector<std::byte> bytes;
    std::size_t vertices = 0;
    std::size_t triangles = 0;
};

/// `method`: draco::MeshEncoderMethod. `speed`: 0 is the best compression, 10 the fastest. Quantises positions to 14
/// bits and other floats to 12.
DracoData draco_encode(const draco::Mesh& mesh, int method, int speed = 5);

/// Makes a file with one compressed primitive. Accessors: POSITION, NORMAL, TEXCOORD_0, COLOR_0, TANGENT, indices.
struct DracoBuilder : GltfBuilder {
    explicit DracoBuilder(const DracoData& data);

    nlohmann::json& primitive() { return json["meshes"][0]["primitives"][0]; }
    nlohmann::json& extension() { return primitive()["extensions"][kDraco]; }
};

} // namespace fieldcast::scene
