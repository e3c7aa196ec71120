// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/steering.h"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace fieldcast::client::play {

/// Reads {"position": [x, y, z], "look_at": [x, y, z]} with +Y up, or {"world_from_camera": [12 numbers]} as in the
/// protocol. With "cut": true, the pose is a jump. Throws UserError, whose message begins with `place`.
net::WantedPose read_pose(const nlohmann::json& json, const std::string& place);

/// The same from JSON text.
net::WantedPose parse_pose(std::string_view text, const std::string& place);

} // namespace fieldcast::client::play
