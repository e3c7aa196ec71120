// SPDX-License-Identifier: Apache-2.0
#include "core/scene/draw_geometry.h"

#include "core/base/error.h"
#include "core/scene/rigid_groups.h"

#include <algorithm>
#include <limits>
#include <span>
#include <unordered_map>

namespace fieldcast::scene {

namespace {

constexpr std::size_t kClusterTriangles = 128; // fewer would cull more triangles, but need more draw calls
constexpr std::size_t kMostIndices = std::numeric_limits<std::int32_t>::max();

/// A triangle in its group's space.
struct PlacedTriangle {
    std::uint32_t part = 0;
    std::uint32_t primitive = 0;
    glm::uvec3 corners{0};
    std::array<glm::vec3, 3> positions{};

    glm::vec3 middle() const { return (positions[0] + positions[1] + positions[2]) / 3.0F; }
};

std::vector<PlacedTriangle> place_triangles(const Scene& scene, const RigidGroup& group, AlphaMode mode) {
    std::vector<PlacedTriangle> placed;
    for (std::uint32_t part = 0; part < group.parts.size(); ++part) {
        const Mesh& mesh = scene.meshes[scene.instances[group.parts[part].instance].mesh];
        if (scene.materials[mesh.material].alpha_mode != mode) {
            continue;
        }
        for (std::uint32_t primitive = 0; primitive < mesh.triangles.size(); ++primitive) {
            PlacedTriangle triangle{part, primitive, mesh.triangles[primitive], {}};
            for (std::uint32_t corner = 0; corner < 3; ++corner) {
                const glm::vec4 position(mesh.positions[triangle.corners[static_cast<int>(corner)]], 1.0F);
                triangle.positions[corner] = glm::vec3(group.parts[part].group_from_object * position);
            }
            placed.push_back(triangle);
        }
    }
    return placed;
}

/// Splits the longest side of the box around the centroids until one cluster is left. Triangles that are close in space
/// are then close in the list.
void sort_in_space(std::span<PlacedTriangle> triangles) {
    if (triangles.size() <= kClusterTriangles) {
        return;
    }
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high = -low;
    for (const PlacedTriangle& triangle : triangles) {
        low = glm::min(low, triangle.middle());
        high = glm::max(high, triangle.middle());
    }
    const glm::vec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const std::size_t clusters = (triangles.size() + kClusterTriangles - 1) / kClusterTriangles;
    const std::size_t half = (clusters + 1) / 2 * kClusterTriangles; // full clusters, except the last one
    std::ranges::nth_element(triangles, triangles.begin() + static_cast<std::ptrdiff_t>(half), {},
                             [axis](const PlacedTriangle& t) { return t.middle()[axis]; });
    sort_in_space(triangles.first(half));
    sort_in_space(triangles.subspan(half));
}

/// Vertices and indices of all clusters.
class Drawing {
public:
    TriangleCluster add(const RigidGroup& group, std::span<const PlacedTriangle> near) {
        known_.clear();
        glm::vec3 low(std::numeric_limits<float>::max());
        glm::vec3 high = -low;
        TriangleCluster cluster{static_cast<std::uint32_t>(indices.size()), 0, {}, {}};
        for (const PlacedTriangle& triangle : near) {
            add(group.parts[triangle.part].instance, triangle);
            for (const glm::vec3& position : triangle.positions) {
                low = glm::min(low, position);
                high = glm::max(high, position);
            }
        }
        cluster.index_count = static_cast<std::uint32_t>(indices.size()) - cluster.first_index;
        cluster.centre = 0.5F * (low + high);
        cluster.half_size = 0.5F * (high - low);
        return cluster;
    }

    std::vector<DrawVertex> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<glm::uvec2> triangles; ///< (instance, primitive)

private:
    /// A vertex of the cluster under construction.
    struct Known {
        std::uint32_t index = 0;
        bool is_first = false; ///< first vertex of a triangle, whose number it holds
    };

    Known& find(std::uint32_t part, std::uint32_t corner, const glm::vec3& position) {
        const std::uint64_t key = std::uint64_t{part} << 32U | corner;
        const auto [found, is_new] = known_.try_emplace(key, Known{static_cast<std::uint32_t>(vertices.size()), false});
        if (is_new) {
            vertices.push_back({position, 0});
        }
        return found->second;
    }

    /// The first vertex must hold the triangle's number, and a vertex can hold only one. Rotating the three vertices
    /// does not change the image.
    void add(std::uint32_t instance, const PlacedTriangle& triangle) {
        std::array<Known*, 3> corners{};
        for (std::uint32_t i = 0; i < 3; ++i) {
            corners[i] = &find(triangle.part, triangle.corners[static_cast<int>(i)], triangle.positions[i]);
        }
        std::size_t first = 0;
        while (first < 3 && corners[first]->is_first) {
            ++first;
        }
        if (first == 3) { // all three hold numbers of other triangles
            first = 0;
            corners[0]->index = static_cast<std::uint32_t>(vertices.size()); // later triangles use the new vertex
            vertices.push_back({triangle.positions[0], 0});
        }
        corners[first]->is_first = true;
        vertices[corners[first]->index].triangle = static_cast<std::uint32_t>(triangles.size());
        triangles.emplace_back(instance, triangle.primitive);
        for (std::size_t i = 0; i < 3; ++i) {
            indices.push_back(corners[(first + i) % 3]->index);
        }
    }

    std::unordered_map<std::uint64_t, Known> known_; ///< key: part and corner
};

} // namespace

DrawGeometry::DrawGeometry(const gpu::Device& device, const Scene& scene, const ScenePose& pose) {
    Drawing drawing;
    for (const RigidGroup& group : rigid_groups(scene, pose)) {
        DrawGroup& drawn = groups_.emplace_back(DrawGroup{group.node, {}});
        for (const AlphaMode mode : {AlphaMode::kOpaque, AlphaMode::kMask, AlphaMode::kBlend}) {
            std::vector<PlacedTriangle> triangles = place_triangles(scene, group, mode);
            if (drawing.indices.size() + 3 * triangles.size() > kMostIndices) {
                throw UserError(scene.name + ": the scene has more than " + std::to_string(kMostIndices / 3) +
                                " placed triangles, the limit of the rasteriser; use --visibility rays");
            }
            sort_in_space(triangles);
            for (std::size_t first = 0; first < triangles.size(); first += kClusterTriangles) {
                const std::size_t count = std::min(kClusterTriangles, triangles.size() - first);
                drawn.clusters[static_cast<std::size_t>(mode)].push_back(
                    drawing.add(group, std::span(triangles).subspan(first, count)));
            }
        }
    }
    vertices_ = gpu::make_buffer<DrawVertex>(device, drawing.vertices);
    indices_ = gpu::make_buffer<std::uint32_t>(device, drawing.indices);
    triangles_ = gpu::make_buffer<glm::uvec2>(device, drawing.triangles);
    triangle_count_ = static_cast<std::uint32_t>(drawing.triangles.size());
}

} // namespace fieldcast::scene
