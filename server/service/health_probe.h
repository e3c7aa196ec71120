// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/host_port.h"

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

namespace fieldcast::service {

/// Which server to ask, and how to reach it.
struct HealthQuestion {
    HostPort address;
    bool uses_tls = false;
    std::filesystem::path ca{};          ///< PEM: who may have signed its certificate; empty: the system's
    std::string name{};                  ///< in its certificate; empty: the host
    std::filesystem::path certificate{}; ///< PEM: ours, if it asks for one; together with `key`
    std::filesystem::path key{};
    std::string token{}; ///< empty: none
    std::chrono::milliseconds timeout{5000};
};

/// Asks grpc.health.v1.Health/Check about the whole server. Nothing: it said SERVING; otherwise what it said, or why it
/// said nothing. Throws UserError if a file cannot be read.
std::optional<std::string> health_problem(const HealthQuestion& question);

} // namespace fieldcast::service
