// SPDX-License-Identifier: Apache-2.0
// The BVH as built on the CPU.
#include "core/base/error.h"
#include "core/scene/bvh.h"
#include "tests/gpu/traversal_reference.h"

#include <cstring>

namespace fieldcast::scene {
namespace {

constexpr std::uint32_t kSeed = 11;

std::vector<Box> random_boxes(std::mt19937& random, std::size_t count, float extent) {
    std::vector<Box> boxes;
    for (const Corners& corners : random_triangles(random, count, extent, 0.1F * extent)) {
        Box& box = boxes.emplace_back();
        for (const glm::vec3& corner : corners) {
            box.extend(corner);
        }
    }
    return boxes;
}

bool contains(const Box& outer, const Box& inner) {
    return glm::all(glm::lessThanEqual(outer.lower, inner.lower)) &&
           glm::all(glm::greaterThanEqual(outer.upper, inner.upper));
}

/// Visits every leaf and checks that decoded boxes contain what lies below. Returns how often each box was met.
class TreeCheck {
public:
    TreeCheck(const WideTree& tree, std::span<const Box> boxes) : tree_(tree), boxes_(boxes), met_(boxes.size()) {
        visit(0, {glm::vec3(-std::numeric_limits<float>::max()), glm::vec3(std::numeric_limits<float>::max())}, 1);
    }
    const std::vector<int>& met() const { return met_; }
    std::uint32_t depth() const { return depth_; }

private:
    void visit(std::uint32_t index, const Box& outer, std::uint32_t depth) {
        depth_ = std::max(depth_, depth);
        const shared::BvhNode& node = tree_.nodes.at(index);
        std::uint32_t child_index = node.first_child;
        std::uint32_t leaf = node.first_triangle;
        for (std::uint32_t slot = 0; slot < shared::kBvhWidth; ++slot) {
            const NodeChild child = decode_child(node, slot);
            if (child.kind == shared::kBvhChildInner) {
                visit(child_index++, child.box, depth + 1);
                continue;
            }
            for (std::uint32_t i = 0; i < child.kind; ++i) {
                const std::uint32_t box = tree_.order.at(leaf++);
                ++met_[box];
                EXPECT_TRUE(contains(child.box, boxes_[box]));
                EXPECT_TRUE(contains(outer, boxes_[box]));
            }
        }
    }

    const WideTree& tree_;
    std::span<const Box> boxes_;
    std::vector<int> met_;
    std::uint32_t depth_ = 0;
};

TEST(BvhTree, HoldsEveryBoxOnceInsideItsParents) {
    std::mt19937 random(kSeed);
    for (const std::size_t count : {1U, 2U, 4U, 5U, 9U, 100U, 5000U}) {
        for (const float extent : {1e-4F, 1.0F, 1e7F}) {
            SCOPED_TRACE(count);
            const std::vector<Box> boxes = random_boxes(random, count, extent);
            const WideTree tree = build_tree(boxes, 0, 0);
            const TreeCheck check(tree, boxes);
            EXPECT_THAT(check.met(), testing::Each(1));
            EXPECT_EQ(check.depth(), tree.depth);
        }
    }
}

TEST(BvhTree, HasARootOverNothing) {
    const WideTree tree = build_tree({}, 0, 0);
    ASSERT_EQ(tree.nodes.size(), 1U);
    for (std::uint32_t slot = 0; slot < shared::kBvhWidth; ++slot) {
        EXPECT_EQ(decode_child(tree.nodes[0], slot).kind, 0U);
    }
}

TEST(BvhTree, StaysShallowWhateverTheBoxes) {
    std::vector<Box> boxes;
    for (int i = 0; i < 3000; ++i) { // each next one a little smaller, nested in the same corner
        boxes.push_back({glm::vec3(0.0F), glm::vec3(std::pow(0.99F, static_cast<float>(i)))});
    }
    const WideTree nested = build_tree(boxes, 0, 0);
    EXPECT_LE(nested.depth, kMaxTreeDepth);
    EXPECT_THAT(TreeCheck(nested, boxes).met(), testing::Each(1));
    boxes.assign(3000, boxes[0]);
    const WideTree identical = build_tree(boxes, 0, 0);
    EXPECT_LE(identical.depth, kMaxTreeDepth);
    EXPECT_THAT(TreeCheck(identical, boxes).met(), testing::Each(1));
}

TEST(Bvh, NeedsATopLevelOnlyForWhatMoves) {
    std::mt19937 random(kSeed);
    Scene scene = empty_scene();
    scene.meshes.push_back(make_mesh(random_triangles(random, 10, 1.0F, 0.2F)));
    for (int i = 0; i < 5; ++i) {
        add_instance(scene, 0, {static_cast<float>(i), 0, 0});
    }
    const Bvh still(scene, pose_scene(scene, 0));
    EXPECT_FALSE(still.is_two_level());
    EXPECT_EQ(still.bottom_level_count(), 1U);
    EXPECT_EQ(still.triangles().size(), 50U);
    const std::uint32_t mover = add_instance(scene, 0);
    add_instance(scene, 0, {0, 1, 0}, mover);
    scene.channels.push_back(
        {mover, AnimationPath::kTranslation, Interpolation::kLinear, {0.0F, 1.0F}, {glm::vec4(0.0F), glm::vec4(1.0F)}});
    scene.duration_s = 1.0;
    const Bvh moving(scene, pose_scene(scene, 0));
    EXPECT_TRUE(moving.is_two_level());
    EXPECT_EQ(moving.bottom_level_count(), 2U) << "what moves with one node shares a bottom level";
    const Bvh shared_meshes(scene, pose_scene(scene, 0), {true, {}});
    EXPECT_EQ(shared_meshes.triangles().size(), 10U);
    EXPECT_EQ(shared_meshes.placed_levels().size(), scene.instances.size());
}

TEST(Bvh, PlacingChangesOnlyTheTopLevel) {
    std::mt19937 random(kSeed);
    Scene scene = one_mesh_scene(random_triangles(random, 100, 1.0F, 0.2F));
    add_instance(scene, 0);
    scene.channels.push_back(
        {1, AnimationPath::kTranslation, Interpolation::kLinear, {0.0F, 1.0F}, {glm::vec4(0.0F), glm::vec4(1.0F)}});
    scene.duration_s = 1.0;
    Bvh bvh(scene, pose_scene(scene, 0));
    const std::vector<shared::BvhNode> before = bvh.nodes();
    bvh.place(pose_scene(scene, 500'000'000));
    ASSERT_EQ(bvh.nodes().size(), before.size());
    const auto top = bvh.top_capacity();
    EXPECT_NE(std::memcmp(before.data(), bvh.nodes().data(), top * sizeof(shared::BvhNode)), 0);
    EXPECT_EQ(
        std::memcmp(before.data() + top, bvh.nodes().data() + top, (before.size() - top) * sizeof(shared::BvhNode)), 0);
}

TEST(Bvh, RefusesGeometryTooFarAway) {
    const Corners far_away{glm::vec3(1e12F, 0, 0), glm::vec3(1e12F, 1e12F, 0), glm::vec3(0, 0, 1)};
    const Scene scene = one_mesh_scene(std::span(&far_away, 1));
    EXPECT_THROW(Bvh(scene, pose_scene(scene, 0)), UserError);
}

TEST(Bvh, SharesMeshesThatAreRepeatedManyTimes) {
    std::mt19937 random(kSeed);
    Scene scene = one_mesh_scene(random_triangles(random, 10000, 1.0F, 0.1F));
    EXPECT_FALSE(should_share_meshes(scene));
    for (int i = 0; i < 900; ++i) {
        add_instance(scene, 0);
    }
    EXPECT_TRUE(should_share_meshes(scene));
}

} // namespace
} // namespace fieldcast::scene
