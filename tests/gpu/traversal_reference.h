// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/speed/device_tracer.h"
#include "core/scene/scene.h"

#include <gmock/gmock.h>
#include <random>

namespace fieldcast::scene {

using Corners = std::array<glm::vec3, 3>;

/// A mesh of single triangles.
Mesh make_mesh(std::span<const Corners> triangles, std::uint32_t material = 0);

/// One opaque material, no nodes.
Scene empty_scene();

/// Adds `mesh` under a new node and returns the node.
std::uint32_t add_instance(Scene& scene, std::uint32_t mesh, const glm::vec3& translation = glm::vec3(0.0F),
                           std::uint32_t parent = kNone);

/// One mesh at the origin.
Scene one_mesh_scene(std::span<const Corners> triangles);

/// Triangles of `size` strewn over a cube of ±`extent` around `centre`.
std::vector<Corners> random_triangles(std::mt19937& random, std::size_t count, float extent, float size,
                                      const glm::vec3& centre = glm::vec3(0.0F));

/// Rays from points in and around that cube in all directions.
std::vector<shared::TraceRay> random_rays(std::mt19937& random, std::size_t count, float extent,
                                          const glm::vec3& centre = glm::vec3(0.0F));

/// All triangles of a pose in double precision, tested one after the other.
class BruteForce {
public:
    BruteForce(const Scene& scene, const ScenePose& pose);

    shared::TraceHit closest(const shared::TraceRay& ray) const;

    /// As conventions.md has it: nearly all hits identical, every other one at the same distance (1e-4 relative) or
    /// decided by an edge that the ray passes within the rounding of the kernels' numbers.
    void expect_agreement(std::span<const shared::TraceRay> rays, std::span<const shared::TraceHit> hits,
                          double least_identical = 0.998) const;

private:
    struct Triangle {
        glm::dvec3 vertex;
        glm::dvec3 edge1;
        glm::dvec3 edge2;
        std::uint32_t instance;
        std::uint32_t primitive;
    };
    struct Meeting {
        double t;
        double inside; ///< least barycentric weight
    };
    static Meeting meet(const Triangle& triangle, const shared::TraceRay& ray);
    bool is_excusable(const shared::TraceRay& ray, const shared::TraceHit& expected,
                      const shared::TraceHit& actual) const;
    bool passes_edge(const shared::TraceRay& ray, const shared::TraceHit& hit) const;

    std::vector<Triangle> triangles_;
};

/// Both traversals, as test parameters; the fixture skips where the device cannot.
std::string traversal_name(const testing::TestParamInfo<Traversal>& info);

} // namespace fieldcast::scene
