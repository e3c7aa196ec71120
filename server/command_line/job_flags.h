// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/channel/offline_job.h"
#include "server/channel/record_job.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fieldcast::command_line {

/// Flags of "render"; `products` are the words of --write.
void add_offline_flags(CLI::App& app, channel::OfflineJob& job, std::vector<std::string>& products);

/// The files that the words of --write ask for.
image::LightFieldProducts read_products(const std::vector<std::string>& words);

/// Flags of "record".
void add_record_flags(CLI::App& app, channel::RecordJob& job);

} // namespace fieldcast::command_line
