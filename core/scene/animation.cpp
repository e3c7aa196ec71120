// SPDX-License-Identifier: Apache-2.0
// Interpolation as in the glTF 2.0 specification, appendix C.
#include "core/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace fieldcast::scene {

namespace {

/// Key times are in single precision and frame times in nanoseconds. Within this tolerance, a frame reaches the last
/// key and is still part of the loop.
constexpr double kLoopTolerance_s = 1e-6;

double seconds(std::int64_t time_ns) {
    return static_cast<double>(time_ns) * 1e-9;
}

/// Time within the loop, from 0 to `duration_s`, both included.
double loop_time_s(const Scene& scene, std::int64_t time_ns) {
    const double phase = seconds(time_ns) - static_cast<double>(loop_index(scene, time_ns)) * scene.duration_s;
    return std::clamp(phase, 0.0, scene.duration_s);
}

glm::vec4 cubic(const AnimationChannel& channel, std::size_t key, float t, float dt) {
    const glm::vec4& value0 = channel.values[3 * key + 1];
    const glm::vec4 tangent0 = channel.values[3 * key + 2] * dt;
    const glm::vec4 tangent1 = channel.values[3 * key + 3] * dt;
    const glm::vec4& value1 = channel.values[3 * key + 4];
    const float t2 = t * t;
    const float t3 = t2 * t;
    return value0 * (2 * t3 - 3 * t2 + 1) + tangent0 * (t3 - 2 * t2 + t) + value1 * (3 * t2 - 2 * t3) +
           tangent1 * (t3 - t2);
}

glm::quat as_quat(const glm::vec4& xyzw) {
    return {xyzw.w, xyzw.x, xyzw.y, xyzw.z};
}
glm::vec4 as_vec4(const glm::quat& q) {
    return {q.x, q.y, q.z, q.w};
}

glm::vec4 linear(const AnimationChannel& channel, std::size_t key, float t) {
    const glm::vec4& value0 = channel.values[key];
    const glm::vec4& value1 = channel.values[key + 1];
    if (channel.path == AnimationPath::kRotation) {
        return as_vec4(glm::slerp(as_quat(value0), as_quat(value1), t)); // the shorter way round
    }
    return glm::mix(value0, value1, t);
}

/// Value of a channel. Before the first key and after the last one it is constant.
glm::vec4 sample(const AnimationChannel& channel, double time_s) {
    const auto& times = channel.times_s;
    const std::size_t stride = channel.interpolation == Interpolation::kCubic ? 3 : 1;
    const auto value_at = [&](std::size_t key) { return channel.values[key * stride + stride / 2]; };
    const auto next = std::upper_bound(times.begin(), times.end(), time_s,
                                       [](double time, float key) { return time < static_cast<double>(key); });
    if (next == times.begin() || next == times.end()) {
        return value_at(next == times.begin() ? 0 : times.size() - 1);
    }
    const auto key = static_cast<std::size_t>(next - times.begin()) - 1;
    const double dt = static_cast<double>(times[key + 1]) - static_cast<double>(times[key]);
    const auto t = static_cast<float>((time_s - static_cast<double>(times[key])) / dt);
    switch (channel.interpolation) {
    case Interpolation::kStep:
        return value_at(key);
    case Interpolation::kLinear:
        return linear(channel, key, t);
    case Interpolation::kCubic:
        return cubic(channel, key, t, static_cast<float>(dt));
    }
    return value_at(key);
}

void apply(const AnimationChannel& channel, double time_s, Node& node) {
    const glm::vec4 value = sample(channel, time_s);
    switch (channel.path) {
    case AnimationPath::kTranslation:
        node.translation = glm::vec3(value);
        break;
    case AnimationPath::kScale:
        node.scale = glm::vec3(value);
        break;
    case AnimationPath::kRotation: {
        const float length = glm::length(value);
        if (length > 1e-6F) { // a cubic curve may pass through zero
            node.rotation = as_quat(value / length);
        }
        break;
    }
    }
}

glm::mat4 parent_from_node(const Node& node) {
    if (node.matrix) {
        return *node.matrix;
    }
    glm::mat4 matrix = glm::mat4_cast(node.rotation);
    for (int axis = 0; axis < 3; ++axis) {
        matrix[axis] *= node.scale[axis];
    }
    matrix[3] = glm::vec4(node.translation, 1.0F);
    return matrix;
}

glm::vec3 unit_or(const glm::vec3& v, const glm::vec3& fallback) {
    const float length = glm::length(v);
    return length > 0.0F && std::isfinite(length) ? v / length : fallback;
}

} // namespace

std::int64_t loop_index(const Scene& scene, std::int64_t time_ns) {
    if (scene.duration_s <= kLoopTolerance_s) { // also keeps the quotient below within the range of 64 bits
        return 0;
    }
    const double loops = std::ceil((seconds(time_ns) - kLoopTolerance_s) / scene.duration_s) - 1.0;
    return static_cast<std::int64_t>(time_ns >= 0 ? std::max(loops, 0.0) : loops);
}

ScenePose pose_scene(const Scene& scene, std::int64_t time_ns) {
    ScenePose pose;
    pose.time_ns = time_ns;
    pose.world_from_node.reserve(scene.nodes.size());
    std::vector<Node> moved = scene.nodes;
    const double time_s = loop_time_s(scene, time_ns);
    for (const AnimationChannel& channel : scene.channels) {
        apply(channel, time_s, moved[channel.node]);
    }
    for (const Node& node : moved) { // parents come first
        const glm::mat4 local = parent_from_node(node);
        pose.world_from_node.push_back(node.parent == kNone ? local : pose.world_from_node[node.parent] * local);
    }
    return pose;
}

const CameraNode* find_camera(const Scene& scene, const std::string& name) {
    const std::string wanted = name.empty() ? "LightField" : name;
    const auto found = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                    [&](const CameraNode& camera) { return camera.name == wanted; });
    if (found != scene.cameras.end()) {
        return &*found;
    }
    return name.empty() && !scene.cameras.empty() ? &scene.cameras.front() : nullptr;
}

glm::mat4 camera_pose(const ScenePose& pose, const CameraNode& camera) {
    const glm::mat4& world_from_node = pose.world_from_node.at(camera.node);
    // The axes follow from backward and up alone, so that a mirrored or sheared node does not affect the image.
    const glm::vec3 back = unit_or(glm::vec3(world_from_node[2]), {0.0F, 0.0F, 1.0F});
    const glm::vec3 up(world_from_node[1]);
    const glm::vec3 any_side = std::abs(back.y) < 0.9F ? glm::vec3(back.z, 0.0F, -back.x) : glm::vec3(1.0F, 0.0F, 0.0F);
    const glm::vec3 right = unit_or(glm::cross(up, back), unit_or(any_side, {1.0F, 0.0F, 0.0F}));
    return {glm::vec4(right, 0.0F), glm::vec4(glm::cross(back, right), 0.0F), glm::vec4(back, 0.0F),
            glm::vec4(glm::vec3(world_from_node[3]), 1.0F)};
}

} // namespace fieldcast::scene
