// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/host_port.h"
#include "core/base/log.h"
#include "core/timing/timing_recorder.h"
#include "server/access/access_watch.h"
#include "server/channel/settings.h"
#include "server/session/limits.h"

#include <filesystem>
#include <optional>

namespace fieldcast::config {

/// Default of --listen: loopback only.
inline const HostPort kDefaultListen{.host = "127.0.0.1", .port = 50151};

/// Everything that a server can be configured with, with defaults. Validated once, then never changed.
struct Config {
    channel::Settings rendering;
    HostPort listen = kDefaultListen;
    std::optional<std::filesystem::path> port_file;
    access::Security security;
    session::Limits limits;
    std::optional<HostPort> metrics_listen; ///< unset: no metrics
    std::optional<std::filesystem::path> metrics_port_file;
    timing::TimingFiles timing_files;
    log::Level log_level = log::Level::kInfo;
    log::Format log_format = log::Format::kText;
};

} // namespace fieldcast::config
