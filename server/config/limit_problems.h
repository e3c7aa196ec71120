// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/channel/settings.h"
#include "server/session/limits.h"

#include <string>
#include <vector>

namespace fieldcast::config {

/// Everything that is wrong with the limits on clients and channels, each with the flag's name.
std::vector<std::string> limit_problems(const session::Limits& limits, const channel::Settings& rendering);

} // namespace fieldcast::config
