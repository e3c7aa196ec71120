// SPDX-License-Identifier: Apache-2.0
#include "core/scene/light_tables.h"

#include "core/scene/alias_table.h"

#include <cmath>
#include <numbers>

namespace fieldcast::scene {

namespace {

constexpr double kPi = std::numbers::pi;

double luminance(const glm::vec3& c) {
    return 0.2126 * static_cast<double>(c.x) + 0.7152 * static_cast<double>(c.y) + 0.0722 * static_cast<double>(c.z);
}

double srgb_to_linear(std::uint8_t value) {
    const double v = value / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

/// Mean emission of a material: its emissive factor times the mean of its emissive texture.
glm::vec3 mean_emission(const Scene& scene, const Material& material) {
    if (material.emissive.texture == kNone) {
        return material.emissive_factor;
    }
    const Image& image = scene.images[scene.textures[material.emissive.texture].image];
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
        sum += glm::dvec3(srgb_to_linear(image.rgba[i]), srgb_to_linear(image.rgba[i + 1]),
                          srgb_to_linear(image.rgba[i + 2]));
    }
    return material.emissive_factor * glm::vec3(sum / std::max(1.0, static_cast<double>(image.rgba.size() / 4)));
}

/// Appends the triangles of one emissive instance to `emitters`, and their fluxes to `flux`.
void append_emitters(const Scene& scene, const glm::mat4& world_from_object, std::uint32_t instance,
                     std::vector<shared::EmitterRecord>& emitters, std::vector<double>& flux) {
    const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
    const Material& material = scene.materials[mesh.material];
    const double exitance = kPi * luminance(mean_emission(scene, material)) * (material.double_sided ? 2.0 : 1.0);
    for (std::uint32_t primitive = 0; primitive < mesh.triangles.size(); ++primitive) {
        const glm::uvec3 corners = mesh.triangles[primitive];
        const glm::mat3 linear(world_from_object);
        const glm::vec3 e1 = linear * (mesh.positions[corners.y] - mesh.positions[corners.x]);
        const glm::vec3 e2 = linear * (mesh.positions[corners.z] - mesh.positions[corners.x]);
        shared::EmitterRecord record{};
        record.instance = instance;
        record.primitive = primitive;
        record.area_m2 = 0.5F * glm::length(glm::cross(e1, e2));
        emitters.push_back(record);
        flux.push_back(exitance * static_cast<double>(record.area_m2));
    }
}

double add_emitters(const Scene& scene, const ScenePose& pose, LightTables& tables) {
    std::vector<double> flux;
    tables.first_emitter.assign(scene.instances.size(), shared::kNoIndex);
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const Material& material = scene.materials[scene.meshes[instance.mesh].material];
        if (luminance(mean_emission(scene, material)) > 0.0) {
            tables.first_emitter[i] = static_cast<std::uint32_t>(tables.emitters.size());
            append_emitters(scene, pose.world_from_node[instance.node], i, tables.emitters, flux);
        }
    }
    const std::vector<AliasEntry> alias = make_alias_table(flux);
    double total = 0.0;
    for (std::size_t i = 0; i < alias.size(); ++i) {
        tables.emitters[i].accept = alias[i].accept;
        tables.emitters[i].alias = alias[i].alias;
        tables.emitters[i].probability = alias[i].probability;
        total += flux[i];
    }
    return total;
}

/// Mean luminance of the 3×3 texels around (x, y). It is zero only where a bilinear lookup is zero, too.
double spread_luminance(const Environment& environment, std::uint32_t x, std::uint32_t y) {
    double sum = 0.0;
    for (std::uint32_t dy = 0; dy < 3; ++dy) {
        const std::uint32_t row = std::min(y + dy > 0 ? y + dy - 1 : 0, environment.height_px - 1);
        for (std::uint32_t dx = 0; dx < 3; ++dx) {
            const std::uint32_t col = (x + dx + environment.width_px - 1) % environment.width_px;
            sum += luminance(environment.pixels[static_cast<std::size_t>(row) * environment.width_px + col]);
        }
    }
    return sum / 9.0;
}

/// Adds the table of the environment. Returns its mean luminance over the sphere.
double add_environment(const Environment& environment, LightTables& tables) {
    if (environment.pixels.empty()) {
        return luminance(environment.constant);
    }
    std::vector<double> weights;
    weights.reserve(environment.pixels.size());
    double total = 0.0;
    for (std::uint32_t y = 0; y < environment.height_px; ++y) {
        const double solid_angle = (std::cos(kPi * y / environment.height_px) -
                                    std::cos(kPi * (y + 1) / environment.height_px)) *
                                   2.0 * kPi / environment.width_px;
        for (std::uint32_t x = 0; x < environment.width_px; ++x) {
            weights.push_back(spread_luminance(environment, x, y) * solid_angle);
            total += weights.back();
        }
    }
    for (const AliasEntry& entry : make_alias_table(weights)) {
        tables.environment.push_back({entry.accept, entry.alias, entry.probability, 0});
    }
    return total / (4.0 * kPi);
}

double light_power(const Light& light, double radius_m) {
    const double intensity = luminance(light.intensity);
    switch (light.type) {
    case LightType::kDirectional:
        return intensity * kPi * radius_m * radius_m;
    case LightType::kPoint:
        return intensity * 4.0 * kPi;
    case LightType::kSpot:
        return intensity * 2.0 * kPi * (1.0 - std::cos(static_cast<double>(light.outer_cone_rad)));
    }
    return 0.0;
}

double add_lights(const Scene& scene, double radius_m, LightTables& tables) {
    double total = 0.0;
    for (const Light& light : scene.lights) {
        total += light_power(light, radius_m);
    }
    for (const Light& light : scene.lights) {
        tables.light_probability.push_back(
            static_cast<float>(total > 0.0 ? light_power(light, radius_m) / total : 0.0));
    }
    return total;
}

} // namespace

LightTables make_light_tables(const Scene& scene, const ScenePose& pose, float scene_radius_m) {
    constexpr double kFloor = 0.15;
    const double radius = static_cast<double>(scene_radius_m);
    LightTables tables;
    const double emitters = add_emitters(scene, pose, tables);
    const double environment = add_environment(scene.environment, tables) * kPi * 4.0 * kPi * radius * radius;
    const double lights = add_lights(scene, radius, tables);
    const double sum = std::sqrt(emitters) + std::sqrt(environment) + std::sqrt(lights);
    if (!(sum > 0.0)) {
        return tables;
    }
    const auto share = [&](double power) { return power > 0.0 ? std::max(kFloor, std::sqrt(power) / sum) : 0.0; };
    const double total = share(emitters) + share(environment) + share(lights);
    tables.probability_emitter = static_cast<float>(share(emitters) / total);
    tables.probability_environment = static_cast<float>(share(environment) / total);
    tables.probability_light = static_cast<float>(share(lights) / total);
    return tables;
}

std::vector<shared::LightRecord> make_light_records(const Scene& scene, const ScenePose& pose,
                                                    const std::vector<float>& probability) {
    std::vector<shared::LightRecord> records;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const Light& light = scene.lights[i];
        const glm::mat4& world_from_node = pose.world_from_node[light.node];
        shared::LightRecord record{};
        record.position = glm::vec3(world_from_node[3]);
        record.type = static_cast<std::uint32_t>(light.type);
        record.direction = glm::normalize(-glm::vec3(world_from_node[2]));
        record.range_m = std::isfinite(light.range_m) ? light.range_m : 0.0F;
        record.intensity = light.intensity;
        record.probability = probability[i];
        record.cos_inner = std::cos(light.inner_cone_rad);
        record.cos_outer = std::cos(light.outer_cone_rad);
        record.cos_radius = std::cos(light.angular_radius_rad);
        records.push_back(record);
    }
    return records;
}

} // namespace fieldcast::scene
