// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/config/config.h"

namespace CLI {
class App;
}

namespace fieldcast::command_line {

/// Flags for the limits on one client, one peer and all of them. They write to `config`, which must outlive `app`.
void add_limit_flags(CLI::App& app, config::Config& config);

} // namespace fieldcast::command_line
