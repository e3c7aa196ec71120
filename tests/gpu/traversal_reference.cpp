// SPDX-License-Identifier: Apache-2.0
#include "tests/gpu/traversal_reference.h"

#include <algorithm>

namespace fieldcast::scene {

namespace {

/// Barycentric distance from an edge within which single precision may decide either way.
constexpr double kEdge = 2e-4;
constexpr double kRelativeDistance = 1e-4;

glm::vec3 random_point(std::mt19937& random, float extent) {
    std::uniform_real_distribution<float> uniform(-extent, extent);
    const float x = uniform(random);
    const float y = uniform(random);
    return {x, y, uniform(random)};
}

bool is_same(const shared::TraceHit& a, const shared::TraceHit& b) {
    return a.instance == b.instance && (a.instance == kNone || a.primitive == b.primitive);
}

} // namespace

Mesh make_mesh(std::span<const Corners> triangles, std::uint32_t material) {
    Mesh mesh;
    mesh.material = material;
    for (const Corners& corners : triangles) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
        mesh.normals.insert(mesh.normals.end(), 3, glm::vec3(0, 1, 0));
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    return mesh;
}

Scene empty_scene() {
    Scene scene;
    scene.name = "test";
    scene.materials.resize(1);
    return scene;
}

std::uint32_t add_instance(Scene& scene, std::uint32_t mesh, const glm::vec3& translation, std::uint32_t parent) {
    const auto node = static_cast<std::uint32_t>(scene.nodes.size());
    scene.nodes.emplace_back();
    scene.nodes.back().translation = translation;
    scene.nodes.back().parent = parent;
    scene.instances.push_back({node, mesh});
    return node;
}

Scene one_mesh_scene(std::span<const Corners> triangles) {
    Scene scene = empty_scene();
    scene.meshes.push_back(make_mesh(triangles));
    add_instance(scene, 0);
    return scene;
}

std::vector<Corners> random_triangles(std::mt19937& random, std::size_t count, float extent, float size,
                                      const glm::vec3& centre) {
    std::vector<Corners> triangles(count);
    for (Corners& corners : triangles) {
        const glm::vec3 middle = centre + random_point(random, extent);
        for (glm::vec3& corner : corners) {
            corner = middle + random_point(random, size);
        }
    }
    return triangles;
}

std::vector<shared::TraceRay> random_rays(std::mt19937& random, std::size_t count, float extent,
                                          const glm::vec3& centre) {
    std::vector<shared::TraceRay> rays(count);
    for (shared::TraceRay& ray : rays) {
        const glm::vec3 origin = centre + random_point(random, 2.0F * extent);
        const glm::vec3 target = centre + random_point(random, extent);
        ray = {origin, std::numeric_limits<float>::max(), glm::normalize(target - origin), 0.0F};
    }
    return rays;
}

BruteForce::BruteForce(const Scene& scene, const ScenePose& pose) {
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        const glm::dmat4 world_from_object(pose.world_from_node[scene.instances[i].node]);
        const auto place = [&](std::uint32_t vertex) {
            return glm::dvec3(world_from_object * glm::dvec4(glm::dvec3(mesh.positions[vertex]), 1.0));
        };
        for (std::uint32_t primitive = 0; primitive < mesh.triangles.size(); ++primitive) {
            const glm::uvec3& corner = mesh.triangles[primitive];
            const glm::dvec3 vertex = place(corner.x);
            triangles_.push_back({vertex, place(corner.y) - vertex, place(corner.z) - vertex, i, primitive});
        }
    }
}

BruteForce::Meeting BruteForce::meet(const Triangle& triangle, const shared::TraceRay& ray) {
    const glm::dvec3 direction(ray.direction);
    const glm::dvec3 p = glm::cross(direction, triangle.edge2);
    const double determinant = glm::dot(triangle.edge1, p);
    if (determinant == 0.0) {
        return {-1.0, -1.0};
    }
    const glm::dvec3 s = glm::dvec3(ray.origin) - triangle.vertex;
    const double u = glm::dot(s, p) / determinant;
    const glm::dvec3 q = glm::cross(s, triangle.edge1);
    const double v = glm::dot(direction, q) / determinant;
    return {glm::dot(triangle.edge2, q) / determinant, std::min({u, v, 1.0 - u - v})};
}

shared::TraceHit BruteForce::closest(const shared::TraceRay& ray) const {
    shared::TraceHit hit{ray.t_max, kNone, 0};
    double nearest = ray.t_max;
    for (const Triangle& triangle : triangles_) {
        const Meeting meeting = meet(triangle, ray);
        if (meeting.inside >= 0.0 && meeting.t > ray.t_min && meeting.t < nearest) {
            nearest = meeting.t;
            hit = {static_cast<float>(nearest), triangle.instance, triangle.primitive};
        }
    }
    return hit;
}

bool BruteForce::passes_edge(const shared::TraceRay& ray, const shared::TraceHit& hit) const {
    const auto found = std::find_if(triangles_.begin(), triangles_.end(), [&](const Triangle& triangle) {
        return triangle.instance == hit.instance && triangle.primitive == hit.primitive;
    });
    return found != triangles_.end() && std::abs(meet(*found, ray).inside) < kEdge;
}

bool BruteForce::is_excusable(const shared::TraceRay& ray, const shared::TraceHit& expected,
                              const shared::TraceHit& actual) const {
    const bool both_hit = expected.instance != kNone && actual.instance != kNone;
    if (both_hit && std::abs(actual.t - expected.t) <= kRelativeDistance * static_cast<double>(expected.t)) {
        return true;
    }
    return passes_edge(ray, expected) || passes_edge(ray, actual);
}

void BruteForce::expect_agreement(std::span<const shared::TraceRay> rays, std::span<const shared::TraceHit> hits,
                                  double least_identical) const {
    ASSERT_EQ(rays.size(), hits.size());
    std::size_t identical = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const shared::TraceHit expected = closest(rays[i]);
        if (is_same(expected, hits[i])) {
            ++identical;
            if (expected.instance != kNone) {
                EXPECT_NEAR(hits[i].t, expected.t, kRelativeDistance * static_cast<double>(expected.t)) << "ray " << i;
            }
            continue;
        }
        EXPECT_TRUE(is_excusable(rays[i], expected, hits[i]))
            << "ray " << i << ": expected " << expected.instance << '/' << expected.primitive << " at " << expected.t
            << ", met " << hits[i].instance << '/' << hits[i].primitive << " at " << hits[i].t;
    }
    EXPECT_GE(static_cast<double>(identical), least_identical * static_cast<double>(rays.size()));
}

std::string traversal_name(const testing::TestParamInfo<Traversal>& info) {
    return info.param == Traversal::kBvh ? "Bvh" : "RayQuery";
}

} // namespace fieldcast::scene
