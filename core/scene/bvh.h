// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/bvh_tree.h"
#include "core/scene/scene.h"

#include <vector>

namespace fieldcast::scene {

struct BvhOptions {
    /// True: one bottom level per mesh, placed by every instance, which needs less memory but makes rays slower. False:
    /// one bottom level in world space for everything static, and one for each animated node.
    bool share_meshes = false;
    TreeOptions tree;
};

/// Whether flattening would duplicate too many triangles, so that meshes should be shared.
bool should_share_meshes(const Scene& scene);

/// Acceleration structure in the kernels' layout (shaders/shared/bvh.h). `scene` must outlive it.
///
/// A bottom level holds triangles that move rigidly together, in the space of the node that moves them. A pose thus
/// changes only the top level, whose nodes come first. A single bottom level in world space needs no top level.
class Bvh {
public:
    /// Builds all levels. Throws UserError if coordinates or counts exceed the range of the records.
    Bvh(const Scene& scene, const ScenePose& pose, const BvhOptions& options = {});

    /// Places the bottom levels according to `pose`. Rewrites only the top level.
    void place(const ScenePose& pose);

    bool is_two_level() const { return top_capacity_ > 0; }

    std::uint32_t bottom_level_count() const { return static_cast<std::uint32_t>(levels_.size()); }
    std::uint32_t top_capacity() const { return top_capacity_; }       ///< nodes reserved for the top level
    std::size_t placement_count() const { return placements_.size(); } ///< greatest number of placed levels
    const std::vector<shared::BvhNode>& nodes() const { return nodes_; }
    const std::vector<shared::LeafTriangle>& triangles() const { return triangles_; }
    const std::vector<shared::PlacedLevel>& placed_levels() const { return placed_; }

private:
    /// Part of a bottom level: an instance (or a mesh, if meshes are shared) and its transform into the level.
    struct Part {
        std::uint32_t mesh = 0;
        std::uint32_t instance = 0;
        glm::mat4 level_from_object{1.0F};
    };
    struct BottomLevel {
        std::vector<Part> parts;
        Box bounds;
        std::uint32_t root = 0;
    };
    struct Placement {
        std::uint32_t level = 0;
        std::uint32_t node = kNone; ///< node whose transform places the level; kNone: none, it is in world space
        std::uint32_t first_instance = 0;
    };

    void flatten(const Scene& scene, const ScenePose& pose);
    void share_meshes(const Scene& scene);
    void build_level(const Scene& scene, BottomLevel& level, const TreeOptions& options);

    std::vector<shared::BvhNode> nodes_;
    std::vector<shared::LeafTriangle> triangles_;
    std::vector<shared::PlacedLevel> placed_;
    std::vector<BottomLevel> levels_;
    std::vector<Placement> placements_;
    std::uint32_t top_capacity_ = 0;
};

} // namespace fieldcast::scene
