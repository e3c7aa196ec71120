// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/channel/settings.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fieldcast::command_line {

/// Flags about source images and views, as they were typed.
struct LightFieldText {
    std::string size = "1280x720";
    std::string convergence; ///< empty: inf, or from the depths in view
    std::string largest_grid = "6x6";
    std::string sources = "middle";
    std::string guard_band = "auto";
};

void add_light_field_flags(CLI::App& app, LightFieldText& text, channel::Settings& rendering);

/// Fills `rendering` from `text`; adds a line to `problems` for everything that cannot be read.
void read_light_field(const LightFieldText& text, channel::Settings& rendering, std::vector<std::string>& problems);

} // namespace fieldcast::command_line
