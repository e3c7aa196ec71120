// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fieldcast::ops {

struct Config;

/// Flags about recordings as they were typed.
struct RecordingText {
    std::vector<std::string> records; ///< FILE or NAME=FILE
    std::vector<std::string> forms;
    std::vector<std::string> replays; ///< FILE or NAME=FILE
};

void add_recording_flags(CLI::App& app, RecordingText& text, Config& config);

/// Fills `config` from `text`; adds a line to `problems` for everything that cannot be read.
void read_recordings(const RecordingText& text, Config& config, std::vector<std::string>& problems);

/// What is wrong with the recordings in `config`, each with the flag's name. `problems_of` asks this.
std::vector<std::string> recording_problems(const Config& config);

} // namespace fieldcast::ops
