// SPDX-License-Identifier: Apache-2.0
#include "core/scene/gltf/lights.h"

#include "core/scene/gltf/numbers.h"

#include <glm/gtc/constants.hpp>

namespace fieldcast::scene {

namespace {

constexpr double kSunRadiusDeg = 0.2665; // glTF has no such property; the default is the size of the sun
constexpr const char* kRadiusMember = "angular_radius_deg";

LightType light_type(const GltfDocument& document, const std::string& type, const std::string& object) {
    if (type == "directional") {
        return LightType::kDirectional;
    }
    if (type != "point" && type != "spot") {
        document.refuse(object, "unknown type '" + type.substr(0, 20) + "'; expected directional, point or spot");
    }
    return type == "point" ? LightType::kPoint : LightType::kSpot;
}

/// Angular radius from the extras, degrees. The node's extras override the light's, as several nodes may share a light.
double angular_radius_deg(const tinygltf::Light& light, const tinygltf::Node& node) {
    return number_member(node.extras, kRadiusMember, number_member(light.extras, kRadiusMember, kSunRadiusDeg));
}

void read_cone(const GltfDocument& document, const tinygltf::SpotLight& spot, const std::string& object, Light& light) {
    constexpr double kMaxCone = 1.570797; // π/2, rounded up to be safe in single precision
    light.outer_cone_rad = checked_float(document, spot.outerConeAngle, object + ": outerConeAngle", {0.0, kMaxCone});
    light.inner_cone_rad = checked_float(document, spot.innerConeAngle, object + ": innerConeAngle", {0.0, kMaxCone});
    if (!(light.inner_cone_rad < light.outer_cone_rad)) {
        document.refuse(object, "innerConeAngle must be smaller than outerConeAngle");
    }
}

Light read_light(const GltfDocument& document, const tinygltf::Light& source, const tinygltf::Node& node,
                 const std::string& object) {
    Light light;
    light.name = node.name.empty() ? source.name : node.name;
    light.type = light_type(document, source.type, object);
    if (!source.color.empty()) {
        light.intensity = checked_vector<glm::vec3>(document, source.color, object + ": color", {});
    }
    for (int i = 0; i < 3; ++i) {
        const double intensity = static_cast<double>(light.intensity[i]) * source.intensity;
        light.intensity[i] = checked_float(document, intensity, object + ": intensity", kEmissionRange);
    }
    const float range = checked_float(document, source.range, object + ": range", {});
    if (range > 0.0F) { // tinygltf returns 0 for an absent range
        light.range_m = range;
    }
    if (light.type == LightType::kSpot) {
        read_cone(document, source.spot, object, light);
    }
    if (light.type == LightType::kDirectional) {
        light.angular_radius_rad = glm::radians(
            checked_float(document, angular_radius_deg(source, node), object + ": angular_radius_deg", {0.0, 89.0}));
    }
    return light;
}

std::optional<float> recommended_spacing(const GltfDocument& document, const tinygltf::Node& node,
                                         const std::string& object) {
    if (!node.extras.Has("fieldcast") || !node.extras.Get("fieldcast").Has("spacing_m")) {
        return std::nullopt;
    }
    const double spacing_m = number_member(node.extras.Get("fieldcast"), "spacing_m", -1.0);
    return checked_float(document, spacing_m, object + ": extras.fieldcast.spacing_m", {1e-6, 1e6});
}

} // namespace

std::vector<Light> read_lights(const GltfDocument& document, const GltfNodes& nodes) {
    std::vector<Light> lights;
    for (std::size_t i = 0; i < nodes.nodes.size(); ++i) {
        const tinygltf::Node& node = file_node(document, nodes, i);
        const auto extension = node.extensions.find("KHR_lights_punctual");
        if (extension == node.extensions.end()) {
            continue;
        }
        const auto index = static_cast<std::size_t>(extension->second.Get("light").GetNumberAsInt());
        const tinygltf::Light& source = document.model.lights[index];
        lights.push_back(read_light(document, source, node, object_name("light", index, source.name)));
        lights.back().node = static_cast<std::uint32_t>(i);
    }
    return lights;
}

std::vector<CameraNode> read_cameras(GltfDocument& document, const GltfNodes& nodes) {
    constexpr double kMinFovy = 1e-4;
    std::vector<CameraNode> cameras;
    for (std::size_t i = 0; i < nodes.nodes.size(); ++i) {
        const tinygltf::Node& node = file_node(document, nodes, i);
        if (node.camera < 0) {
            continue;
        }
        const auto index = static_cast<std::size_t>(node.camera);
        const tinygltf::Camera& source = document.model.cameras[index];
        if (source.type != "perspective") {
            document.warnings.add("orthographic cameras are ignored", "node");
            continue;
        }
        CameraNode camera;
        camera.name = node.name.empty() ? source.name : node.name;
        camera.node = static_cast<std::uint32_t>(i);
        camera.fovy_rad =
            checked_float(document, source.perspective.yfov, object_name("camera", index, source.name) + ": yfov",
                          {kMinFovy, glm::pi<double>() - kMinFovy});
        camera.spacing_m = recommended_spacing(document, node, node_name(document, nodes.file_index[i]));
        cameras.push_back(std::move(camera));
    }
    return cameras;
}

} // namespace fieldcast::scene
