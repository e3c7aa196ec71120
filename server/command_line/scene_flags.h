// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/channel/settings.h"

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fieldcast::command_line {

class WordFlags;

/// Flags about scenes and the camera "auto", as they were typed.
struct SceneText {
    std::vector<std::string> scenes;
    std::vector<std::string> channels; ///< NAME=FILE
    std::string environment;
    std::string sky; ///< R,G,B
    std::string look_from;
    std::string look_at;
    std::optional<float> fov_deg;
};

void add_scene_flags(CLI::App& app, WordFlags& words, SceneText& text, channel::Settings& rendering);

/// Fills `rendering` from `text`; adds a line to `problems` for everything that cannot be read.
void read_scenes(const SceneText& text, channel::Settings& rendering, std::vector<std::string>& problems);

} // namespace fieldcast::command_line
