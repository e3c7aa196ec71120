// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/host_port.h"

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

namespace fieldcast::service {

/// The server to probe, and the access to it.
struct HealthQuestion {
    HostPort address;
    bool uses_tls = false;
    std::filesystem::path ca{};          ///< PEM: authorities for its certificate; empty: the system's
    std::string name{};                  ///< name in its certificate; empty: the host
    std::filesystem::path certificate{}; ///< PEM: client certificate; used together with `key`
    std::filesystem::path key{};
    std::string token{}; ///< empty: none
    std::chrono::milliseconds timeout{5000};
};

/// Calls grpc.health.v1.Health/Check for the whole server. Returns nothing if the answer is SERVING, otherwise the
/// answer or the reason for its absence. Throws UserError if a file cannot be read.
std::optional<std::string> health_problem(const HealthQuestion& question);

} // namespace fieldcast::service
