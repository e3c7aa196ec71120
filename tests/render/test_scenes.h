// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/camera.h"
#include "core/scene/scene.h"

namespace fieldcast::render {

/// Collects meshes, materials and lights into a scene with a black sky.
class SceneBuilder {
public:
    SceneBuilder() { scene_.environment.constant = glm::vec3(0.0F); }

    std::uint32_t add_material(scene::Material material);
    /// An image of `width_px` columns and a texture that shows it.
    std::uint32_t add_texture(std::uint32_t width_px, std::vector<std::uint8_t> rgba,
                              scene::Wrap wrap = scene::Wrap::kRepeat);
    std::uint32_t add_node(const glm::mat4& world_from_node);
    /// Adds an instance of `mesh` with a material; returns the instance.
    std::uint32_t add(scene::Mesh mesh, std::uint32_t material, const glm::mat4& world_from_object = glm::mat4(1.0F));
    /// Moves a node without parent from one position to another within a second. Its rotation and scale are reset.
    void slide(std::uint32_t node, const glm::vec3& from, const glm::vec3& to);
    void add_light(scene::Light light, const glm::mat4& world_from_node);
    scene::Environment& environment() { return scene_.environment; }
    scene::Scene& scene() { return scene_; }

private:
    scene::Scene scene_;
};

/// A surface that reflects `colour` diffusely and nothing else (ior 1: no interface).
scene::Material diffuse(const glm::vec3& colour);
scene::Material metal(const glm::vec3& colour, float roughness);
/// A black surface that emits on its front only.
scene::Material emitter(const glm::vec3& radiance);

/// Rectangle with corners centre ± u ± v and front towards cross(u, v). Texture u is along `u`, v against `v`
/// (upright image).
scene::Mesh rectangle(const glm::vec3& centre, const glm::vec3& u, const glm::vec3& v);
/// Axis-aligned box with flat normals that face outwards.
scene::Mesh box(const glm::vec3& centre, const glm::vec3& half);
enum class Shading { kFlat, kSmooth };
/// Latitude-longitude sphere around the origin; `slices` around the y axis, half as many from pole to pole.
scene::Mesh sphere(float radius_m, std::uint32_t slices, Shading shading);
/// The mesh with reversed winding and normals.
scene::Mesh turned_inside_out(scene::Mesh mesh);

/// Camera at `eye` towards `target`, +Y up (+Z if it looks straight up or down).
Camera look_at(const glm::vec3& eye, const glm::vec3& target, float fovy_rad, std::uint32_t width_px,
               std::uint32_t height_px);

/// Translation of a node.
glm::mat4 at(const glm::vec3& position);
/// Node at `position` whose −Z points along `direction`.
glm::mat4 facing(const glm::vec3& position, const glm::vec3& direction);

/// The Cornell box of tools/make_cornell_reference.py.
scene::Scene cornell_box();
Camera cornell_camera(std::uint32_t size_px);

/// A room of coloured walls with two boxes, all diffuse. A point light beside the camera lights it, without noise.
scene::Scene point_lit_room();
/// The same room under a rectangle light.
scene::Scene area_lit_room();
/// The same room lit by a white sky through its open side.
scene::Scene sky_lit_room();
Camera room_camera(std::uint32_t width_px, std::uint32_t height_px);

} // namespace fieldcast::render
