// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders/shared/bvh.h"

#include <array>
#include <glm/glm.hpp>
#include <limits>

namespace fieldcast::scene {

/// Axis-aligned box, metres. Starts empty: upper < lower.
struct Box {
    glm::vec3 lower{std::numeric_limits<float>::infinity()};
    glm::vec3 upper{-std::numeric_limits<float>::infinity()};

    void extend(const glm::vec3& point);
    void extend(const Box& other);
    bool is_empty() const { return !(lower.x <= upper.x); }
    float half_area() const;
};

/// Largest magnitude of a coordinate in a BVH, metres. Larger cells do not fit the exponents of shared::BvhNode.
inline constexpr float kMaxCoordinate = 1e10F;

/// One child of a node that is to be encoded.
struct NodeChild {
    Box box;
    std::uint32_t kind = 0; ///< kBvhChildInner, or number of triangles (0: unused slot)
};

/// Encodes a node whose inner children precede its leaves. Decoded boxes contain the given ones.
shared::BvhNode encode_node(const std::array<NodeChild, shared::kBvhWidth>& children, std::uint32_t first_child,
                            std::uint32_t first_triangle);

/// Decodes the child in `slot` as the kernels do; for tests and references on the CPU.
NodeChild decode_child(const shared::BvhNode& node, std::uint32_t slot);

} // namespace fieldcast::scene
