// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/ops/offline_job.h"
#include "server/ops/record_job.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fieldcast::ops {

/// Flags of "render"; `products` are the words of --write.
void add_offline_flags(CLI::App& app, OfflineJob& job, std::vector<std::string>& products);

/// Flags of "record".
void add_record_flags(CLI::App& app, RecordJob& job);

} // namespace fieldcast::ops
