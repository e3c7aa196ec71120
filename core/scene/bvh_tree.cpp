// SPDX-License-Identifier: Apache-2.0
// Binary tree by Embree, then the best 4-wide tree over it.
// Follows: H. Ylitie, T. Karras, S. Laine. Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs.
// HPG 2017, section 3.1 (dynamic programming over the binary tree). Differs: four children instead of eight.
#include "core/scene/bvh_tree.h"

#include "core/base/error.h"
#include "core/scene/bvh_embree.h"

#include <algorithm>
#include <memory>
#include <numeric>

namespace fieldcast::scene {

namespace {

/// Beyond this depth of the binary tree Embree splits in the middle. 4-wide trees are about half as deep.
constexpr std::uint32_t kMaxBinaryDepth = 48;

/// A node of the binary tree, with the least costs of representing it by at most 1, 2 or 3 wide nodes or leaves.
struct Branch {
    Box box;
    float cost[3]{};
    std::uint32_t count = 1;     ///< number of primitives below
    std::uint32_t primitive = 0; ///< the primitive of a node without children
    bool is_leaf = true;         ///< becomes a leaf of the wide tree if represented by one node
    Branch* child[2]{};
};

/// Cost of representing the children of `branch` by `total` nodes, `left` of them for the first child.
float split_cost(const Branch& branch, std::uint32_t left, std::uint32_t total) {
    return branch.child[0]->cost[left - 1] + branch.child[1]->cost[total - left - 1];
}

/// The best `left` for split_cost.
std::uint32_t best_split(const Branch& branch, std::uint32_t total) {
    std::uint32_t best = 1;
    for (std::uint32_t left = 2; left < total; ++left) {
        if (split_cost(branch, left, total) < split_cost(branch, best, total)) {
            best = left;
        }
    }
    return best;
}

void set_costs(Branch& branch, const TreeOptions& options) {
    const float area = branch.box.half_area();
    const float as_leaf = area * static_cast<float>(branch.count) * options.triangle_cost;
    if (branch.child[0] == nullptr) {
        std::fill(std::begin(branch.cost), std::end(branch.cost), as_leaf);
        return;
    }
    const float as_node = area * options.node_cost + split_cost(branch, best_split(branch, 4), 4);
    branch.is_leaf = branch.count <= options.max_leaf_size && as_leaf <= as_node;
    branch.cost[0] = branch.is_leaf ? as_leaf : as_node;
    branch.cost[1] = std::min(branch.cost[0], split_cost(branch, best_split(branch, 2), 2));
    branch.cost[2] = std::min(branch.cost[1], split_cost(branch, best_split(branch, 3), 3));
}

void join(Branch& branch, Branch* first, Branch* second, const TreeOptions& options) {
    branch.child[0] = first;
    branch.child[1] = second;
    branch.box = first->box;
    branch.box.extend(second->box);
    branch.count = first->count + second->count;
    set_costs(branch, options);
}

Box box_of(const RTCBuildPrimitive& p) {
    return {{p.lower_x, p.lower_y, p.lower_z}, {p.upper_x, p.upper_y, p.upper_z}};
}

void* create_node(RTCThreadLocalAllocator allocator, unsigned int, void*) {
    return new (rtcThreadLocalAlloc(allocator, sizeof(Branch), 16)) Branch;
}

void set_children(void* node, void** children, unsigned int count, void* options) {
    FC_ASSERT(count == 2, "the tree must be binary");
    join(*static_cast<Branch*>(node), static_cast<Branch*>(children[0]), static_cast<Branch*>(children[1]),
         *static_cast<const TreeOptions*>(options));
}

void set_bounds(void*, const RTCBounds**, unsigned int, void*) {} // join() sets the bounds

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count,
                  void* options) {
    FC_ASSERT(count == 1, "Embree must not make leaves of several primitives");
    auto* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(Branch), 16)) Branch;
    leaf->box = box_of(*primitives);
    leaf->primitive = primitives->primID;
    set_costs(*leaf, *static_cast<const TreeOptions*>(options));
    return leaf;
}

struct ReleaseEmbree {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCBVH bvh) const { rtcReleaseBVH(bvh); }
};
using EmbreeDevice = std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseEmbree>;
using EmbreeBvh = std::unique_ptr<std::remove_pointer_t<RTCBVH>, ReleaseEmbree>;

/// The root of Embree's tree; null if Embree cannot keep within the depth. The nodes live as long as `bvh`.
Branch* build_with_embree(std::vector<RTCBuildPrimitive>& primitives, RTCBVH bvh, TreeOptions options) {
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.byteSize = sizeof(arguments);
    arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor = 2;
    arguments.maxDepth = kMaxBinaryDepth;
    arguments.minLeafSize = 1;
    arguments.maxLeafSize = 1;
    arguments.bvh = bvh;
    arguments.primitives = primitives.data();
    arguments.primitiveCount = primitives.size();
    arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = create_leaf;
    arguments.userPtr = &options;
    return static_cast<Branch*>(rtcBuildBVH(&arguments));
}

/// Splits at the median of the longest axis. The boxes are worse than Embree's, but the depth is the least possible.
Branch* build_balanced(std::span<const Box> boxes, std::span<std::uint32_t> indices, std::vector<Branch>& storage,
                       const TreeOptions& options) {
    Branch* branch = &storage.emplace_back(); // no reallocation: `storage` has the capacity
    if (indices.size() == 1) {
        branch->box = boxes[indices[0]];
        branch->primitive = indices[0];
        set_costs(*branch, options);
        return branch;
    }
    Box centres;
    for (const std::uint32_t index : indices) {
        centres.extend(boxes[index].lower + boxes[index].upper);
    }
    const glm::vec3 size = centres.upper - centres.lower;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const auto centre = [&](std::uint32_t index) { return boxes[index].lower[axis] + boxes[index].upper[axis]; };
    const std::size_t half = indices.size() / 2;
    std::nth_element(indices.begin(), indices.begin() + static_cast<std::ptrdiff_t>(half), indices.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return centre(a) < centre(b); });
    Branch* first = build_balanced(boxes, indices.first(half), storage, options);
    join(*branch, first, build_balanced(boxes, indices.subspan(half), storage, options), options);
    return branch;
}

/// Writes the wide tree of least cost according to set_costs().
class Widener {
public:
    Widener(std::uint32_t first_node, std::uint32_t first_leaf, bool leaf_nodes)
        : first_node_(first_node), first_leaf_(first_leaf), leaf_nodes_(leaf_nodes) {}

    WideTree widen(const Branch& root) {
        tree_.nodes.resize(1);
        tree_.order.reserve(root.count);
        tree_.bounds = root.box;
        write_node(root, 0, 1);
        return std::move(tree_);
    }

private:
    struct Children {
        std::array<const Branch*, shared::kBvhWidth> branch{};
        std::uint32_t count = 0;
        std::uint32_t inner_count = 0; ///< number of inner children, which come first
    };

    /// Appends the best representation of `branch` by at most `budget` children.
    static void gather(const Branch& branch, std::uint32_t budget, Children& children) {
        while (budget > 1 && budget < 4 && branch.cost[budget - 1] == branch.cost[budget - 2]) {
            --budget;
        }
        if (budget == 1 || branch.child[0] == nullptr) {
            children.branch[children.count++] = &branch;
            return;
        }
        const std::uint32_t left = best_split(branch, budget);
        gather(*branch.child[0], left, children);
        gather(*branch.child[1], budget - left, children);
    }

    void append_leaf(const Branch& branch) {
        if (branch.child[0] == nullptr) {
            tree_.order.push_back(branch.primitive);
            return;
        }
        append_leaf(*branch.child[0]);
        append_leaf(*branch.child[1]);
    }

    Children children_of(const Branch& branch) const {
        Children children;
        gather(branch, branch.is_leaf ? 1 : 4, children);
        const auto end = children.branch.begin() + children.count;
        const auto is_inner = [this](const Branch* child) { return leaf_nodes_ || !child->is_leaf; };
        const auto leaves = std::stable_partition(children.branch.begin(), end, is_inner);
        children.inner_count = static_cast<std::uint32_t>(leaves - children.branch.begin());
        return children;
    }

    void write_node(const Branch& branch, std::size_t index, std::uint32_t depth) {
        tree_.depth = std::max(tree_.depth, depth);
        const Children children = children_of(branch);
        const auto first_child = static_cast<std::uint32_t>(tree_.nodes.size());
        const auto first_leaf = static_cast<std::uint32_t>(tree_.order.size());
        std::array<NodeChild, shared::kBvhWidth> slots;
        for (std::uint32_t slot = 0; slot < children.count; ++slot) {
            const Branch& child = *children.branch[slot];
            slots[slot] = {child.box, slot < children.inner_count ? shared::kBvhChildInner : child.count};
        }
        tree_.nodes[index] = encode_node(slots, first_node_ + first_child, first_leaf_ + first_leaf);
        tree_.nodes.resize(first_child + children.inner_count);
        for (std::uint32_t slot = children.inner_count; slot < children.count; ++slot) {
            append_leaf(*children.branch[slot]);
        }
        for (std::uint32_t slot = 0; slot < children.inner_count; ++slot) {
            const Branch& child = *children.branch[slot];
            if (child.is_leaf) {
                tree_.nodes[first_child + slot].shape = shared::kBvhPlaced | child.primitive;
            } else {
                write_node(child, first_child + slot, depth + 1);
            }
        }
    }

    WideTree tree_;
    std::uint32_t first_node_;
    std::uint32_t first_leaf_;
    bool leaf_nodes_;
};

std::vector<RTCBuildPrimitive> build_primitives(std::span<const Box> boxes) {
    std::vector<RTCBuildPrimitive> primitives(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const auto& [lower, upper] = boxes[i];
        primitives[i] = {lower.x, lower.y, lower.z, 0, upper.x, upper.y, upper.z, static_cast<std::uint32_t>(i)};
    }
    return primitives;
}

} // namespace

WideTree build_tree(std::span<const Box> boxes, std::uint32_t first_node, std::uint32_t first_leaf,
                    const TreeOptions& options) {
    if (boxes.empty()) {
        return {{encode_node({}, first_node, first_leaf)}, {}, {}, 1};
    }
    static const EmbreeDevice device(rtcNewDevice(nullptr)); // starting Embree takes milliseconds
    FC_ASSERT(device != nullptr, "Embree cannot create a device");
    std::vector<RTCBuildPrimitive> primitives = build_primitives(boxes);
    const EmbreeBvh bvh(rtcNewBVH(device.get()));
    if (const Branch* root = build_with_embree(primitives, bvh.get(), options)) {
        WideTree tree = Widener(first_node, first_leaf, options.leaf_nodes).widen(*root);
        if (tree.depth <= kMaxTreeDepth) {
            return tree;
        }
    }
    std::vector<std::uint32_t> indices(boxes.size());
    std::iota(indices.begin(), indices.end(), 0U);
    std::vector<Branch> storage;
    storage.reserve(2 * boxes.size());
    const Branch* root = build_balanced(boxes, indices, storage, options);
    WideTree tree = Widener(first_node, first_leaf, options.leaf_nodes).widen(*root);
    FC_ASSERT(tree.depth <= kMaxTreeDepth, "a balanced tree is too deep");
    return tree;
}

} // namespace fieldcast::scene
