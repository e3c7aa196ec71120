// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/steering.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

// Camera poses of a user who steers from the command line.
namespace fieldcast::client::play {

/// The pose `seconds` after we began to steer, or nothing if there is no new one since the last call. `start`: the pose
/// of the camera at the beginning.
using PoseSource = std::function<std::optional<net::WantedPose>(double seconds, const glm::mat4& start)>;

/// "orbit:radius=2,seconds=10": a turn every 10 s around the point 2 m in front of the camera, +Y up. "-": poses from
/// standard input, one JSON object per line; the newest is used. Anything else is a file: a JSON array of such objects
/// with their `time_s`. Throws UserError.
PoseSource read_camera_path(const std::string& text);

/// The pose after `share` of a turn around the point `radius_m` in front of `start`.
glm::mat4 orbit_pose(const glm::mat4& start, float radius_m, double share);

/// Reads poses and their times. Between two poses, position and rotation are interpolated; before the first and after
/// the last pose, the camera rests. Throws UserError.
PoseSource read_path_file(const std::filesystem::path& file);

} // namespace fieldcast::client::play
