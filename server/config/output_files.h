// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/config/config.h"

namespace fieldcast::config {

/// Files that a server is to write and cannot, or must not because another flag names them too. Nothing is written.
std::vector<std::string> output_problems(const Config& config);

} // namespace fieldcast::config
