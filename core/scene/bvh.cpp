// SPDX-License-Identifier: Apache-2.0
#include "core/scene/bvh.h"

#include "core/base/error.h"
#include "core/scene/rigid_groups.h"
#include "shaders/shared/scene.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace fieldcast::scene {

namespace {

constexpr std::uint64_t kManyTriangles = 8ULL << 20;
constexpr std::uint64_t kMuchSharing = 4;
/// Boxes grow by this fraction of the largest coordinate. It covers the kernel's rounding of origin − plane.
constexpr float kPadding = 0x1p-21F;

std::uint32_t alpha_flags(const Material& material) {
    return static_cast<std::uint32_t>(material.alpha_mode) |
           (material.double_sided ? shared::kMaterialDoubleSided : 0U);
}

float largest_coordinate(const Box& box) {
    const glm::vec3 largest = glm::max(glm::abs(box.lower), glm::abs(box.upper));
    return std::max({largest.x, largest.y, largest.z});
}

void pad(Box& box, float by) {
    box.lower -= by;
    box.upper += by;
}

Box box_of(const shared::LeafTriangle& triangle) {
    Box box;
    box.extend(triangle.vertex);
    box.extend(triangle.vertex + triangle.edge1);
    box.extend(triangle.vertex + triangle.edge2);
    return box;
}

Box transform(const glm::mat4& matrix, const Box& box) {
    Box result;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 point((corner & 1) != 0 ? box.upper.x : box.lower.x,
                              (corner & 2) != 0 ? box.upper.y : box.lower.y,
                              (corner & 4) != 0 ? box.upper.z : box.lower.z);
        result.extend(glm::vec3(matrix * glm::vec4(point, 1.0F)));
    }
    return result;
}

void check_bounds(const Scene& scene, const Box& box) {
    if (!box.is_empty() && !(largest_coordinate(box) <= kMaxCoordinate)) {
        throw UserError(scene.name + ": geometry lies farther than 1e10 m from the origin; move or scale it");
    }
}

void check_counts(const Scene& scene, std::size_t nodes, std::size_t triangles) {
    if (nodes > shared::kBvhMaxNodes || triangles > (1ULL << 31)) {
        throw UserError(scene.name + ": " + std::to_string(triangles) + " placed triangles need " +
                        std::to_string(nodes) + " BVH nodes; the limit is " + std::to_string(shared::kBvhMaxNodes) +
                        ", so use a simpler scene");
    }
}

shared::PlacedLevel placed_level(const glm::mat4& level_from_world, std::uint32_t root, std::uint32_t first_instance) {
    const glm::mat4 rows = glm::transpose(level_from_world);
    return {{rows[0], rows[1], rows[2]}, root, first_instance, 0, 0};
}

} // namespace

bool should_share_meshes(const Scene& scene) {
    std::uint64_t unique = 0;
    std::uint64_t placed = 0;
    for (const Mesh& mesh : scene.meshes) {
        unique += mesh.triangles.size();
    }
    for (const Instance& instance : scene.instances) {
        placed += scene.meshes[instance.mesh].triangles.size();
    }
    return placed > kManyTriangles && placed > kMuchSharing * unique;
}

Bvh::Bvh(const Scene& scene, const ScenePose& pose, const BvhOptions& options) {
    if (options.share_meshes || should_share_meshes(scene)) {
        share_meshes(scene);
    } else {
        flatten(scene, pose);
    }
    const bool in_world = placements_.empty() || (placements_.size() == 1 && placements_[0].node == kNone);
    // A binary tree over n levels has at most n − 1 inner nodes; one more node per level places it.
    top_capacity_ = in_world ? 0 : static_cast<std::uint32_t>(2 * placements_.size());
    nodes_.resize(top_capacity_);
    for (BottomLevel& level : levels_) {
        build_level(scene, level, options.tree);
    }
    if (levels_.empty()) {
        nodes_ = build_tree({}, 0, 0).nodes;
    }
    place(pose);
}

void Bvh::flatten(const Scene& scene, const ScenePose& pose) {
    for (const RigidGroup& group : rigid_groups(scene, pose)) {
        placements_.push_back({bottom_level_count(), group.node, 0});
        BottomLevel& level = levels_.emplace_back();
        for (const RigidPart& part : group.parts) {
            level.parts.push_back({scene.instances[part.instance].mesh, part.instance, part.group_from_object});
        }
    }
}

void Bvh::share_meshes(const Scene& scene) {
    levels_.resize(scene.meshes.size());
    for (std::uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        levels_[mesh].parts.push_back({mesh, 0, glm::mat4(1.0F)});
    }
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        placements_.push_back({scene.instances[i].mesh, scene.instances[i].node, i});
    }
}

void Bvh::build_level(const Scene& scene, BottomLevel& level, const TreeOptions& options) {
    std::vector<shared::LeafTriangle> triangles;
    for (const Part& part : level.parts) {
        const Mesh& mesh = scene.meshes[part.mesh];
        const std::uint32_t flags = alpha_flags(scene.materials[mesh.material]);
        const auto place_vertex = [&](std::uint32_t vertex) {
            return glm::vec3(part.level_from_object * glm::vec4(mesh.positions[vertex], 1.0F));
        };
        for (std::uint32_t primitive = 0; primitive < mesh.triangles.size(); ++primitive) {
            const glm::uvec3& corner = mesh.triangles[primitive];
            const glm::vec3 vertex = place_vertex(corner.x);
            triangles.push_back({vertex, part.instance, place_vertex(corner.y) - vertex, primitive,
                                 place_vertex(corner.z) - vertex, flags});
        }
    }
    std::vector<Box> boxes(triangles.size());
    std::transform(triangles.begin(), triangles.end(), boxes.begin(), box_of);
    for (const Box& box : boxes) {
        level.bounds.extend(box);
    }
    check_bounds(scene, level.bounds);
    const float padding = kPadding * std::max(largest_coordinate(level.bounds), 1e-6F);
    std::for_each(boxes.begin(), boxes.end(), [padding](Box& box) { pad(box, padding); });
    level.root = static_cast<std::uint32_t>(nodes_.size());
    const WideTree tree = build_tree(boxes, level.root, static_cast<std::uint32_t>(triangles_.size()), options);
    check_counts(scene, nodes_.size() + tree.nodes.size(), triangles_.size() + triangles.size());
    nodes_.insert(nodes_.end(), tree.nodes.begin(), tree.nodes.end());
    for (const std::uint32_t index : tree.order) {
        triangles_.push_back(triangles[index]);
    }
}

void Bvh::place(const ScenePose& pose) {
    if (!is_two_level()) {
        return;
    }
    std::vector<Box> boxes;
    placed_.clear();
    for (const Placement& placement : placements_) {
        const BottomLevel& level = levels_[placement.level];
        const glm::mat4 world_from_level =
            placement.node == kNone ? glm::mat4(1.0F) : pose.world_from_node[placement.node];
        const double volume = std::abs(glm::determinant(glm::dmat4(world_from_level)));
        if (level.bounds.is_empty() || !(volume > 0.0)) {
            continue; // its scale is 0 in some direction
        }
        Box box = transform(world_from_level, level.bounds);
        pad(box, 4.0F * kPadding * largest_coordinate(box));
        boxes.push_back(box);
        const glm::mat4 level_from_world(glm::inverse(glm::dmat4(world_from_level)));
        placed_.push_back(placed_level(level_from_world, level.root, placement.first_instance));
    }
    const WideTree tree = build_tree(boxes, 0, 0, {.max_leaf_size = 1, .leaf_nodes = true});
    FC_ASSERT(tree.nodes.size() <= top_capacity_, "the top level exceeds its reserved nodes");
    std::copy(tree.nodes.begin(), tree.nodes.end(), nodes_.begin());
}

} // namespace fieldcast::scene
