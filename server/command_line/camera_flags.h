// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/channel/settings.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fieldcast::command_line {

/// Flags about who moves the cameras, as they were typed.
struct CameraText {
    std::vector<std::string> controls; ///< CONTROL, or NAME=CONTROL
    double steering_lease_s = 5.0;
};

void add_camera_flags(CLI::App& app, CameraText& text);

/// Call it when `rendering` has its channels. Adds a line to `problems` for everything that cannot be read.
void read_cameras(const CameraText& text, channel::Settings& rendering, std::vector<std::string>& problems);

} // namespace fieldcast::command_line
