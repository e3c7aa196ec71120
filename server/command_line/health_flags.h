// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/service/health_probe.h"

#include <string>

namespace CLI {
class App;
}

namespace fieldcast::command_line {

/// --health and its further flags, as they were typed.
struct HealthText {
    std::string server; ///< HOST:PORT or https://HOST:PORT; empty: not asked for
    std::string ca;
    std::string name;
    std::string token_file;
};

void add_health_flags(CLI::App& app, HealthText& text);

/// Throws UserError naming the flag. `certificate` and `key` are presented to a server that requires one.
service::HealthQuestion read_health(const HealthText& text, const std::string& certificate, const std::string& key);

} // namespace fieldcast::command_line
