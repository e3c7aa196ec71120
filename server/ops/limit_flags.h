// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/ops/config.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fieldcast::ops {

/// The flags that bound what one client, one peer or everybody may use; they fill `config`.
void add_limit_flags(CLI::App& app, Config& config);

/// What is wrong with these limits, each with the flag's name.
std::vector<std::string> limit_problems(const Config& config);

} // namespace fieldcast::ops
