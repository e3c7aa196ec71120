// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/steering.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

// Where a user who steers from the command line wants the camera.
namespace fieldcast::client::play {

/// The pose at a moment, `seconds` after we began to steer, if there is a new one since the last call. `start`: where
/// the camera was when we came.
using PoseSource = std::function<std::optional<net::WantedPose>(double seconds, const glm::mat4& start)>;

/// "orbit:radius=2,seconds=10": around the point `radius` metres in front of where the camera was, +Y up, once in so
/// many seconds. "-": poses from standard input, one JSON object a line, the newest wins. Else a file: a JSON array of
/// such objects with their `time_s`. Throws UserError.
PoseSource read_camera_path(const std::string& text);

/// The camera's way round, after `share` of a turn.
glm::mat4 orbit_pose(const glm::mat4& start, float radius_m, double share);

/// {"position": [x, y, z], "look_at": [x, y, z]}, or {"world_from_camera": [12 numbers]} as in the protocol; with
/// "cut": true it is a jump. Throws UserError that begins with `place`.
net::WantedPose parse_pose(std::string_view json, const std::string& place);

/// Poses at times: between two of them position and rotation are interpolated, before the first and after the last the
/// camera rests there. Throws UserError.
PoseSource read_path_file(const std::filesystem::path& file);

} // namespace fieldcast::client::play
