// SPDX-License-Identifier: Apache-2.0
#include "tests/render/test_scenes.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

namespace fieldcast::render {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

glm::vec3 sphere_point(std::uint32_t stack, std::uint32_t slice, std::uint32_t slices) {
    const float theta = kPi * static_cast<float>(stack) / static_cast<float>(slices / 2);
    const float phi = 2.0F * kPi * static_cast<float>(slice % slices) / static_cast<float>(slices);
    return {std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi)};
}

/// Appends a triangle with its own vertices, but skips triangles without area (at the poles).
void append_triangle(scene::Mesh& mesh, const std::array<glm::vec3, 3>& p, const std::array<glm::vec3, 3>& n) {
    if (glm::length(glm::cross(p[1] - p[0], p[2] - p[0])) < 1e-9F) {
        return;
    }
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    mesh.positions.insert(mesh.positions.end(), p.begin(), p.end());
    mesh.normals.insert(mesh.normals.end(), n.begin(), n.end());
}

void append(scene::Mesh& mesh, const scene::Mesh& other) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::uvec3& triangle : other.triangles) {
        mesh.triangles.push_back(triangle + first);
    }
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
    mesh.uv0.insert(mesh.uv0.end(), other.uv0.begin(), other.uv0.end());
}

/// Floor, ceiling, back wall, left and right wall of a room −1 … 1, open towards +z.
void add_walls(SceneBuilder& builder, const std::array<glm::vec3, 5>& colours, float depth_m) {
    const glm::vec3 x(1, 0, 0);
    const glm::vec3 y(0, 1, 0);
    const glm::vec3 z(0, 0, 0.5F * depth_m);
    const glm::vec3 middle(0, 0, -1.0F + 0.5F * depth_m);
    builder.add(rectangle(middle - y, x, -z), builder.add_material(diffuse(colours[0])));
    builder.add(rectangle(middle + y, x, z), builder.add_material(diffuse(colours[1])));
    builder.add(rectangle({0, 0, -1}, x, y), builder.add_material(diffuse(colours[2])));
    builder.add(rectangle(middle - x, -z, y), builder.add_material(diffuse(colours[3])));
    builder.add(rectangle(middle + x, z, y), builder.add_material(diffuse(colours[4])));
}

SceneBuilder room() {
    SceneBuilder builder;
    add_walls(builder,
              {glm::vec3(0.6F, 0.5F, 0.4F), glm::vec3(0.7F), glm::vec3(0.4F, 0.5F, 0.7F), glm::vec3(0.7F, 0.3F, 0.2F),
               glm::vec3(0.3F, 0.6F, 0.3F)},
              3.0F);
    builder.add(box({-0.4F, -0.6F, -0.3F}, {0.25F, 0.4F, 0.25F}), builder.add_material(diffuse({0.7F, 0.7F, 0.3F})));
    builder.add(box({0.45F, -0.75F, 0.1F}, {0.3F, 0.25F, 0.2F}), builder.add_material(diffuse({0.5F, 0.3F, 0.6F})));
    return builder;
}

} // namespace

std::uint32_t SceneBuilder::add_material(scene::Material material) {
    scene_.materials.push_back(std::move(material));
    return static_cast<std::uint32_t>(scene_.materials.size() - 1);
}

std::uint32_t SceneBuilder::add_texture(std::uint32_t width_px, std::vector<std::uint8_t> rgba, scene::Wrap wrap) {
    const auto height = static_cast<std::uint32_t>(rgba.size() / 4 / width_px);
    scene_.images.push_back({"test image", width_px, height, std::move(rgba)});
    scene_.textures.push_back({static_cast<std::uint32_t>(scene_.images.size() - 1), wrap, wrap});
    return static_cast<std::uint32_t>(scene_.textures.size() - 1);
}

std::uint32_t SceneBuilder::add_node(const glm::mat4& world_from_node) {
    scene::Node node;
    node.matrix = world_from_node;
    scene_.nodes.push_back(std::move(node));
    return static_cast<std::uint32_t>(scene_.nodes.size() - 1);
}

std::uint32_t SceneBuilder::add(scene::Mesh mesh, std::uint32_t material, const glm::mat4& world_from_object) {
    mesh.material = material;
    scene_.meshes.push_back(std::move(mesh));
    scene_.instances.push_back({add_node(world_from_object), static_cast<std::uint32_t>(scene_.meshes.size() - 1)});
    return static_cast<std::uint32_t>(scene_.instances.size() - 1);
}

void SceneBuilder::slide(std::uint32_t node, const glm::vec3& from, const glm::vec3& to) {
    scene_.nodes[node] = {};
    scene_.nodes[node].is_animated = true;
    scene_.channels.push_back({.node = node,
                               .path = scene::AnimationPath::kTranslation,
                               .times_s = {0, 1},
                               .values = {glm::vec4(from, 0.0F), glm::vec4(to, 0.0F)}});
    scene_.duration_s = 1.0;
}

void SceneBuilder::add_light(scene::Light light, const glm::mat4& world_from_node) {
    light.node = add_node(world_from_node);
    scene_.lights.push_back(std::move(light));
}

scene::Material diffuse(const glm::vec3& colour) {
    scene::Material material;
    material.base_colour_factor = glm::vec4(colour, 1.0F);
    material.metallic_factor = 0.0F;
    material.ior = 1.0F;
    return material;
}

scene::Material metal(const glm::vec3& colour, float roughness) {
    scene::Material material;
    material.base_colour_factor = glm::vec4(colour, 1.0F);
    material.roughness_factor = roughness;
    return material;
}

scene::Material emitter(const glm::vec3& radiance) {
    scene::Material material = diffuse(glm::vec3(0.0F));
    material.emissive_factor = radiance;
    return material;
}

scene::Mesh rectangle(const glm::vec3& centre, const glm::vec3& u, const glm::vec3& v) {
    scene::Mesh mesh;
    mesh.positions = {centre - u - v, centre + u - v, centre + u + v, centre - u + v};
    mesh.normals.assign(4, glm::normalize(glm::cross(u, v)));
    mesh.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

scene::Mesh box(const glm::vec3& centre, const glm::vec3& half) {
    scene::Mesh mesh;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0F, 1.0F}) {
            glm::vec3 out(0.0F);
            glm::vec3 u(0.0F);
            glm::vec3 v(0.0F);
            out[axis] = side * half[axis];
            u[(axis + 1) % 3] = side * half[(axis + 1) % 3];
            v[(axis + 2) % 3] = half[(axis + 2) % 3];
            append(mesh, rectangle(centre + out, u, v));
        }
    }
    return mesh;
}

scene::Mesh sphere(float radius_m, std::uint32_t slices, Shading shading) {
    scene::Mesh mesh;
    for (std::uint32_t stack = 0; stack < slices / 2; ++stack) {
        for (std::uint32_t slice = 0; slice < slices; ++slice) {
            const glm::vec3 a = sphere_point(stack, slice, slices);
            const glm::vec3 b = sphere_point(stack + 1, slice, slices);
            const glm::vec3 c = sphere_point(stack + 1, slice + 1, slices);
            const glm::vec3 d = sphere_point(stack, slice + 1, slices);
            for (const auto& t : {std::array{a, b, c}, std::array{a, c, d}}) {
                const glm::vec3 flat = glm::cross(t[1] - t[0], t[2] - t[0]);
                const glm::vec3 unit = flat / std::max(glm::length(flat), 1e-20F);
                append_triangle(mesh, {t[0] * radius_m, t[1] * radius_m, t[2] * radius_m},
                                shading == Shading::kSmooth ? t : std::array{unit, unit, unit});
            }
        }
    }
    return mesh;
}

scene::Mesh turned_inside_out(scene::Mesh mesh) {
    for (glm::uvec3& triangle : mesh.triangles) {
        std::swap(triangle.y, triangle.z);
    }
    for (glm::vec3& normal : mesh.normals) {
        normal = -normal;
    }
    return mesh;
}

glm::mat4 facing(const glm::vec3& position, const glm::vec3& direction) {
    const bool vertical = std::abs(glm::normalize(direction).y) > 0.999F;
    return glm::inverse(
        glm::lookAt(position, position + direction, vertical ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0)));
}

Camera look_at(const glm::vec3& eye, const glm::vec3& target, float fovy_rad, std::uint32_t width_px,
               std::uint32_t height_px) {
    return make_camera(facing(eye, target - eye), fovy_rad, width_px, height_px);
}

glm::mat4 at(const glm::vec3& position) {
    return glm::translate(glm::mat4(1.0F), position);
}

scene::Scene cornell_box() {
    SceneBuilder builder;
    const glm::vec3 white(0.7F);
    add_walls(builder, {white, white, white, glm::vec3(0.6F, 0.06F, 0.05F), glm::vec3(0.12F, 0.45F, 0.1F)}, 2.0F);
    builder.add(rectangle({0, 0.99F, 0}, {0.4F, 0, 0}, {0, 0, 0.4F}), builder.add_material(emitter({12, 10, 7})));
    const glm::mat4 tall = at({-0.35F, -0.4F, -0.35F}) * glm::rotate(glm::mat4(1.0F), 0.3F, glm::vec3(0, 1, 0));
    const glm::mat4 low = at({0.4F, -0.7F, 0.3F}) * glm::rotate(glm::mat4(1.0F), -0.3F, glm::vec3(0, 1, 0));
    builder.add(box({}, {0.3F, 0.6F, 0.3F}), builder.add_material(metal(glm::vec3(1.0F), std::sqrt(0.1F))), tall);
    builder.add(box({}, {0.3F, 0.3F, 0.3F}), builder.add_material(diffuse(white)), low);
    return builder.scene();
}

Camera cornell_camera(std::uint32_t size_px) {
    // The camera is off the axis of symmetry, because no edge of the room may run through pixel centres.
    return look_at({0.06F, 0.03F, 3.9F}, {0.02F, 0.01F, 0}, glm::radians(39.3F), size_px, size_px);
}

scene::Scene point_lit_room() {
    SceneBuilder builder = room();
    scene::Light light;
    light.type = scene::LightType::kPoint;
    light.intensity = glm::vec3(6.0F, 5.5F, 5.0F);
    builder.add_light(light, at({0.2F, 0.3F, 2.4F}));
    return builder.scene();
}

scene::Scene area_lit_room() {
    SceneBuilder builder = room();
    builder.add(rectangle({0, 0.98F, 0.3F}, {0.6F, 0, 0}, {0, 0, 0.6F}),
                builder.add_material(emitter(glm::vec3(6.0F))));
    return builder.scene();
}

scene::Scene sky_lit_room() {
    SceneBuilder builder = room();
    builder.environment().constant = glm::vec3(1.0F);
    return builder.scene();
}

Camera room_camera(std::uint32_t width_px, std::uint32_t height_px) {
    return look_at({0, 0, 2.8F}, {0, 0, 0}, glm::radians(40.0F), width_px, height_px);
}

} // namespace fieldcast::render
