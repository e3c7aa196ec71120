// SPDX-License-Identifier: Apache-2.0
#include "core/scene/mesh_normals.h"

#include <cmath>

namespace fieldcast::scene {

namespace {

constexpr glm::vec3 kUp{0.0F, 0.0F, 1.0F};

/// Unit vector along `v`, or `fallback` if `v` is zero or not finite. Doubles are used because squares of tiny or huge
/// floats leave the range of floats.
glm::vec3 direction_of(const glm::dvec3& v, const glm::vec3& fallback) {
    const double length = glm::length(v);
    return length > 0.0 && std::isfinite(length) ? glm::vec3(v / length) : fallback;
}

glm::dvec3 area_vector(const Mesh& mesh, const glm::uvec3& triangle) {
    const glm::dvec3 a(mesh.positions[triangle.x]);
    return glm::cross(glm::dvec3(mesh.positions[triangle.y]) - a, glm::dvec3(mesh.positions[triangle.z]) - a);
}

template <class T> void give_each_corner_its_own(std::vector<T>& attribute, const std::vector<glm::uvec3>& triangles) {
    if (attribute.empty()) {
        return;
    }
    std::vector<T> expanded;
    expanded.reserve(triangles.size() * 3);
    for (const glm::uvec3& triangle : triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            expanded.push_back(attribute[triangle[corner]]);
        }
    }
    attribute = std::move(expanded);
}

bool is_unit(const glm::vec3& v) {
    return std::abs(glm::dot(v, v) - 1.0F) < 1e-6F;
}

/// Area-weighted normals of the triangles around each vertex.
std::vector<glm::vec3> smooth_normals(const Mesh& mesh) {
    std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
    for (const glm::uvec3& triangle : mesh.triangles) {
        const glm::dvec3 area = area_vector(mesh, triangle);
        for (int corner = 0; corner < 3; ++corner) {
            sums[triangle[corner]] += area;
        }
    }
    std::vector<glm::vec3> normals;
    normals.reserve(sums.size());
    for (const glm::dvec3& sum : sums) {
        normals.push_back(direction_of(sum, kUp));
    }
    return normals;
}

glm::vec3 any_perpendicular(const glm::vec3& n) {
    const glm::vec3 axis = std::abs(n.x) < 0.7F ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    return glm::normalize(glm::cross(n, axis));
}

} // namespace

void make_flat_normals(Mesh& mesh) {
    give_each_corner_its_own(mesh.tangents, mesh.triangles);
    give_each_corner_its_own(mesh.uv0, mesh.triangles);
    give_each_corner_its_own(mesh.uv1, mesh.triangles);
    give_each_corner_its_own(mesh.colours, mesh.triangles);
    give_each_corner_its_own(mesh.positions, mesh.triangles);
    mesh.normals.clear();
    mesh.normals.reserve(mesh.positions.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        mesh.triangles[i] = glm::uvec3(3 * i, 3 * i + 1, 3 * i + 2);
        mesh.normals.insert(mesh.normals.end(), 3, direction_of(area_vector(mesh, mesh.triangles[i]), kUp));
    }
}

void normalise_frames(Mesh& mesh) {
    std::vector<glm::vec3> replacements;
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        glm::vec3& normal = mesh.normals[i];
        if (is_unit(normal)) {
            continue;
        }
        if (normal == glm::vec3(0.0F) && replacements.empty()) {
            replacements = smooth_normals(mesh);
        }
        normal = normal == glm::vec3(0.0F) ? replacements[i] : direction_of(glm::dvec3(normal), kUp);
    }
    for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
        glm::vec4& tangent = mesh.tangents[i];
        const glm::vec3 direction(tangent);
        const glm::vec3 unit =
            is_unit(direction) ? direction : direction_of(glm::dvec3(direction), any_perpendicular(mesh.normals[i]));
        tangent = glm::vec4(unit, tangent.w < 0.0F ? -1.0F : 1.0F);
    }
}

} // namespace fieldcast::scene
