// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/channel/settings.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fieldcast::command_line {

class WordFlags;

/// Flags about rendering whose text is read when the grid is known, or that have words of their own.
struct RenderText {
    std::string preset = "default"; ///< sets the defaults of the other flags
    std::string holes = "all";
    std::string exposure = "auto";
    bool lacks_next_event_estimation = false;
};

/// Defaults are what `text` and `rendering` have now.
void add_render_flags(CLI::App& app, WordFlags& words, RenderText& text, channel::Settings& rendering);

/// Fills `rendering`, which knows the largest grid; adds a line to `problems` for everything that cannot be read.
void read_rendering(const RenderText& text, channel::Settings& rendering, std::vector<std::string>& problems);

} // namespace fieldcast::command_line
