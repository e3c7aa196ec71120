// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/channel/settings.h"

#include <string>
#include <vector>

namespace fieldcast::config {

/// Everything that is wrong with the recordings and replays of `rendering`, each with the flag's name.
std::vector<std::string> recording_problems(const channel::Settings& rendering);

} // namespace fieldcast::config
