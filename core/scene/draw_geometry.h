// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/buffer.h"
#include "core/scene/scene.h"

#include <array>

namespace fieldcast::scene {

/// A vertex that a vertex shader fetches in one access. The first vertex of a triangle holds the triangle's number.
struct DrawVertex {
    glm::vec3 position;     ///< metres, in the space of its group
    std::uint32_t triangle; ///< index into DrawGeometry::triangles()
};

/// Triangles that are close to each other, and their bounding box in their group's space.
struct TriangleCluster {
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;
    glm::vec3 centre{0.0F};
    glm::vec3 half_size{0.0F};
};

/// Triangles that move rigidly together, by the alpha mode of their materials. Clusters that are close in space are
/// close in the list, and so are their indices.
struct DrawGroup {
    std::uint32_t node = kNone;                           ///< node whose transform places it; kNone: world space
    std::array<std::vector<TriangleCluster>, 3> clusters; ///< indexed by AlphaMode
};

/// The triangles of a scene for a rasteriser. They do not depend on the pose after construction.
class DrawGeometry {
public:
    /// Throws UserError if there are more triangles than can be drawn.
    DrawGeometry(const gpu::Device& device, const Scene& scene, const ScenePose& pose);

    const gpu::Buffer& vertices() const { return vertices_; }   ///< DrawVertex
    const gpu::Buffer& indices() const { return indices_; }     ///< u32
    const gpu::Buffer& triangles() const { return triangles_; } ///< (instance, primitive), as in shared::Visibility
    std::uint32_t triangle_count() const { return triangle_count_; }
    std::uint64_t device_bytes() const {
        return vertices_.size_bytes() + indices_.size_bytes() + triangles_.size_bytes();
    }
    const std::vector<DrawGroup>& groups() const { return groups_; }

private:
    std::vector<DrawGroup> groups_;
    gpu::Buffer vertices_;
    gpu::Buffer indices_;
    gpu::Buffer triangles_;
    std::uint32_t triangle_count_ = 0;
};

} // namespace fieldcast::scene
