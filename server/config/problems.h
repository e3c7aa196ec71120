// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/config/config.h"

#include <string>
#include <vector>

namespace fieldcast::config {

/// Everything that is wrong with `config`, each with the flag's name; empty: nothing.
std::vector<std::string> problems_of(const Config& config);

} // namespace fieldcast::config
