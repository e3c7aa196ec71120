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

/// Flags about recordings as they were typed.
struct RecordingText {
    std::vector<std::string> records; ///< FILE or NAME=FILE
    std::vector<std::string> forms;
    std::vector<std::string> replays; ///< FILE or NAME=FILE
    std::optional<float> replay_fps;  ///< of all replays; unset: as recorded
};

void add_recording_flags(CLI::App& app, RecordingText& text, channel::Settings& rendering);

/// Fills `rendering` from `text`; adds a line to `problems` for everything that cannot be read.
void read_recordings(const RecordingText& text, channel::Settings& rendering, std::vector<std::string>& problems);

} // namespace fieldcast::command_line
