// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/play/server_options.h"
#include "core/scene/scene.h"

#include <filesystem>
#include <stop_token>
#include <string>

namespace fieldcast::client::play {

/// Loads the scene of `channel` (empty: the server's first channel) from the cache folder or from the server. Throws
/// net::NetError if the server cannot be reached within `server.patience`, UserError for an unknown channel.
scene::Scene obtain_scene(const ServerOptions& server, const std::string& channel,
                          const std::filesystem::path& cache_folder, const std::stop_token& stop);

} // namespace fieldcast::client::play
