// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/config/config.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fieldcast::command_line {

class WordFlags;

/// Flags about listening, logs and measurements, as they were typed.
struct ServingText {
    std::string listen = to_text(config::kDefaultListen);
    std::string port_file;
    std::string metrics_listen;
    std::string metrics_port_file;
    std::string frame_log;
    std::string trace;
};

void add_serving_flags(CLI::App& app, WordFlags& words, ServingText& text, config::Config& config);

/// Fills `config` from `text`; adds a line to `problems` for everything that cannot be read.
void read_serving(const ServingText& text, config::Config& config, std::vector<std::string>& problems);

} // namespace fieldcast::command_line
