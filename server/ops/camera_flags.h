// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/ops/flag_text.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fieldcast::ops {

/// The flags that say who moves the cameras.
void add_camera_flags(CLI::App& app, FlagText& text);

/// After the channels; adds a line to `problems` for everything that cannot be read.
void read_camera_controls(const FlagText& text, Config& config, std::vector<std::string>& problems);

} // namespace fieldcast::ops
