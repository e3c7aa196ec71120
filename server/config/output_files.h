// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/config/config.h"

namespace fieldcast::config {

/// Problems of output files: files that cannot be written, or that another flag names as well. Writes nothing.
std::vector<std::string> output_problems(const Config& config);

} // namespace fieldcast::config
