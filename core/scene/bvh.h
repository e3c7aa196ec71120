// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/bvh_tree.h"
#include "core/scene/scene.h"

#include <vector>

namespace fieldcast::scene {

struct BvhOptions {
    /// One bottom level per mesh, placed by every instance: less memory, slower rays. Otherwise flattened: one bottom
    /// level in world space for all that stands still, and one for what moves with each animated node.
    bool share_meshes = false;
    TreeOptions tree;
};

/// Whether flattening would repeat so many triangles that meshes should be shared.
bool should_share_meshes(const Scene& scene);

/// Our own acceleration structure, laid out for the kernels (shaders/shared/bvh.h). `scene` must outlive it.
///
/// A bottom level holds what moves rigidly together, in the space of the node that moves it, so a pose changes only
/// the top level, whose nodes come first. A single bottom level in world space needs no top level.
class Bvh {
public:
    /// Builds everything. Throws UserError if coordinates or counts exceed what the records can hold.
    Bvh(const Scene& scene, const ScenePose& pose, const BvhOptions& options = {});

    /// Places the bottom levels as in `pose`: rewrites the top level, nothing else.
    void place(const ScenePose& pose);

    bool is_two_level() const { return top_capacity_ > 0; }

    std::uint32_t bottom_level_count() const { return static_cast<std::uint32_t>(levels_.size()); }
    std::uint32_t top_capacity() const { return top_capacity_; }       ///< nodes reserved for the top level
    std::size_t placement_count() const { return placements_.size(); } ///< most placed levels there can be
    const std::vector<shared::BvhNode>& nodes() const { return nodes_; }
    const std::vector<shared::LeafTriangle>& triangles() const { return triangles_; }
    const std::vector<shared::PlacedLevel>& placed_levels() const { return placed_; }

private:
    /// Part of a bottom level: an instance (or a mesh, if meshes are shared) and how it lies in the level.
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
        std::uint32_t node = kNone; ///< whose transform places it; kNone: the world
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
