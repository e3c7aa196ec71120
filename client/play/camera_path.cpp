// SPDX-License-Identifier: Apache-2.0
#include "client/play/camera_path.h"

#include "client/play/live_poses.h"
#include "client/play/pose_text.h"
#include "core/base/error.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <vector>

namespace fieldcast::client::play {
namespace {

struct TimedPose {
    double time_s = 0.0;
    net::WantedPose pose;
};

/// The number of `name` in a list such as "radius=2,seconds=10"; `otherwise` if it is missing, 0 if it is malformed.
double number_named(const std::string& text, const std::string& name, double otherwise) {
    std::istringstream parts(text);
    for (std::string part; std::getline(parts, part, ',');) {
        if (part.starts_with(name + "=")) {
            std::size_t used = 0;
            const std::string value = part.substr(name.size() + 1);
            const double number = value.empty() ? 0.0 : std::stod(value, &used);
            return used == value.size() ? number : 0.0;
        }
    }
    return otherwise;
}

PoseSource read_orbit(const std::string& text) {
    constexpr const char* kForm = "--steer: write orbit:radius=METRES,seconds=SECONDS, both above 0";
    try {
        const double radius_m = number_named(text, "radius", 2.0);
        const double seconds = number_named(text, "seconds", 20.0);
        if (radius_m > 0.0 && radius_m < 1e6 && seconds > 0.0 && seconds < 1e6) {
            return [=](double now_s, const glm::mat4& start) {
                return net::WantedPose{orbit_pose(start, static_cast<float>(radius_m), now_s / seconds), false};
            };
        }
    } catch (const std::logic_error&) { // of std::stod
    }
    throw UserError(kForm);
}

glm::mat4 between(const glm::mat4& a, const glm::mat4& b, float share) {
    const glm::quat rotation = glm::slerp(glm::quat_cast(glm::mat3(a)), glm::quat_cast(glm::mat3(b)), share);
    glm::mat4 pose(glm::mat3_cast(glm::normalize(rotation)));
    pose[3] = glm::vec4(glm::mix(glm::vec3(a[3]), glm::vec3(b[3]), share), 1.0F);
    return pose;
}

/// The pose at `now_s`. Pose `next` is the first one after `now_s`.
net::WantedPose pose_at(const std::vector<TimedPose>& poses, std::size_t next, double now_s) {
    if (next == 0) {
        return poses.front().pose;
    }
    const TimedPose& before = poses[next - 1];
    if (next == poses.size() || poses[next].pose.cut) { // jumps are not interpolated
        return before.pose;
    }
    const TimedPose& after = poses[next];
    const auto share = static_cast<float>((now_s - before.time_s) / (after.time_s - before.time_s));
    return {between(before.pose.world_from_camera, after.pose.world_from_camera, share), false};
}

std::vector<TimedPose> read_timed_poses(const std::filesystem::path& file) {
    std::ifstream stream(file);
    const nlohmann::json json = nlohmann::json::parse(stream, nullptr, false);
    if (!json.is_array() || json.empty()) {
        throw UserError("--steer " + file.string() + ": cannot be read as a JSON array of poses");
    }
    std::vector<TimedPose> poses;
    for (const nlohmann::json& entry : json) {
        const std::string place = "--steer " + file.string() + ": pose " + std::to_string(poses.size());
        const net::WantedPose pose = read_pose(entry, place);
        const double time_s =
            entry.contains("time_s") && entry["time_s"].is_number() ? entry["time_s"].get<double>() : -1.0;
        if (!(time_s >= 0.0) || (!poses.empty() && !(time_s > poses.back().time_s))) {
            throw UserError(place + ": needs time_s, which must be 0 or more and later than that of the previous pose");
        }
        poses.push_back({time_s, pose});
    }
    return poses;
}

} // namespace

glm::mat4 orbit_pose(const glm::mat4& start, float radius_m, double share) {
    const glm::vec3 centre = glm::vec3(start[3]) - radius_m * glm::vec3(start[2]); // cameras look along -Z
    const auto angle = static_cast<float>(2.0 * std::numbers::pi * (share - std::floor(share)));
    glm::mat4 round = glm::rotate(glm::translate(glm::mat4(1.0F), centre), angle, glm::vec3(0.0F, 1.0F, 0.0F));
    return glm::translate(round, -centre) * start;
}

PoseSource read_path_file(const std::filesystem::path& file) {
    return [poses = read_timed_poses(file), jumped = std::size_t{0}](double now_s, const glm::mat4&) mutable {
        const auto later = std::ranges::upper_bound(poses, now_s, {}, &TimedPose::time_s);
        const auto next = static_cast<std::size_t>(later - poses.begin());
        net::WantedPose pose = pose_at(poses, next, now_s);
        pose.cut = false; // set below, once per jump
        for (; jumped < next; ++jumped) {
            pose.cut = pose.cut || poses[jumped].pose.cut;
        }
        return std::optional(pose);
    };
}

PoseSource read_camera_path(const std::string& text) {
    constexpr std::string_view kOrbit = "orbit";
    if (text == "-") {
        const auto live = std::make_shared<LivePoses>(0);
        return [live](double, const glm::mat4&) { return live->take(); };
    }
    if (text == kOrbit || text.starts_with("orbit:")) {
        return read_orbit(text.substr(std::min(text.size(), kOrbit.size() + 1)));
    }
    return read_path_file(text);
}

} // namespace fieldcast::client::play
