// SPDX-License-Identifier: Apache-2.0
#include "client/play/pose_text.h"

#include "core/base/error.h"

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

namespace fieldcast::client::play {
namespace {

template <std::size_t kCount>
std::array<float, kCount> numbers_of(const nlohmann::json& json, const std::string& place) {
    std::array<float, kCount> numbers{};
    if (!json.is_array() || json.size() != kCount) {
        throw UserError(place + ": write " + std::to_string(kCount) + " numbers");
    }
    for (std::size_t i = 0; i < kCount; ++i) {
        if (!json[i].is_number() || !std::isfinite(json[i].get<float>())) {
            throw UserError(place + ": write " + std::to_string(kCount) + " finite numbers");
        }
        numbers[i] = json[i].get<float>();
    }
    return numbers;
}

glm::mat4 looking(const glm::vec3& position, const glm::vec3& target, const std::string& place) {
    const glm::vec3 backwards = position - target;
    const glm::vec3 right = glm::cross(glm::vec3(0.0F, 1.0F, 0.0F), backwards);
    if (!(glm::length(right) > 0.0F)) {
        throw UserError(place + ": the camera looks straight up, down or nowhere; give world_from_camera instead");
    }
    const glm::vec3 z = glm::normalize(backwards);
    const glm::vec3 x = glm::normalize(right);
    return {glm::vec4(x, 0.0F), glm::vec4(glm::cross(z, x), 0.0F), glm::vec4(z, 0.0F), glm::vec4(position, 1.0F)};
}

} // namespace

net::WantedPose read_pose(const nlohmann::json& json, const std::string& place) {
    if (!json.is_object()) {
        throw UserError(place + R"(: write an object, as in {"position": [0, 1, 3], "look_at": [0, 1, 0]})");
    }
    net::WantedPose pose;
    pose.cut = json.value("cut", nlohmann::json(false)) == true;
    if (json.contains("world_from_camera")) {
        const auto values = numbers_of<12>(json["world_from_camera"], place + ": world_from_camera");
        for (int i = 0; i < 12; ++i) {
            pose.world_from_camera[i / 3][i % 3] = values[static_cast<std::size_t>(i)];
        }
        return pose;
    }
    if (!json.contains("position") || !json.contains("look_at")) {
        throw UserError(place + ": needs position and look_at, or world_from_camera");
    }
    const auto position = numbers_of<3>(json["position"], place + ": position");
    const auto target = numbers_of<3>(json["look_at"], place + ": look_at");
    pose.world_from_camera =
        looking({position[0], position[1], position[2]}, {target[0], target[1], target[2]}, place);
    return pose;
}

net::WantedPose parse_pose(std::string_view text, const std::string& place) {
    return read_pose(nlohmann::json::parse(text, nullptr, false), place);
}

} // namespace fieldcast::client::play
