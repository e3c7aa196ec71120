// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/bvh_node.h"

#include <span>
#include <vector>

namespace fieldcast::scene {

/// The kernels' stack has one entry per node on the path. It must hold two levels and the marker between them.
inline constexpr std::uint32_t kMaxTreeDepth = (shared::kBvhStackSize - 1) / 2;

struct TreeOptions {
    std::uint32_t max_leaf_size = shared::kBvhMaxLeafSize; ///< 1 … kBvhMaxLeafSize
    float node_cost = 1.0F;                                ///< cost of visiting a node, relative to `triangle_cost`
    float triangle_cost = 0.6F;
    bool leaf_nodes = false; ///< leaves (of one box) are nodes of shape kBvhPlaced | box index, as in the top level
};

/// A tree of 4-wide nodes over `boxes`. Node indices count from `first_node`, leaf indices from `first_leaf`.
struct WideTree {
    std::vector<shared::BvhNode> nodes; ///< root first; without boxes there is only an empty root
    std::vector<std::uint32_t> order;   ///< indices into the boxes, in leaf order
    Box bounds;
    std::uint32_t depth = 1; ///< nodes on the longest path
};

/// Builds a tree by the surface area heuristic. Boxes must be finite. Depth is at most kMaxTreeDepth.
WideTree build_tree(std::span<const Box> boxes, std::uint32_t first_node, std::uint32_t first_leaf,
                    const TreeOptions& options = {});

} // namespace fieldcast::scene
