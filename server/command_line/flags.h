// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/channel/offline_job.h"
#include "server/channel/record_job.h"
#include "server/command_line/inspect_job.h"
#include "server/config/config.h"
#include "server/service/health_probe.h"

#include <string>
#include <vector>

namespace fieldcast::command_line {

/// The task of a command line, with its settings.
struct Invocation {
    enum class Kind : std::uint8_t {
        kServe,
        kPrint,   ///< print `text` only: --help, --version, --print-config, --make-token
        kCheck,   ///< validate only
        kHealth,  ///< ask another server for its health only
        kRender,  ///< `job`, without serving
        kRecord,  ///< `record_job`, without serving
        kInspect, ///< `inspect_job`, without a device
    };
    Kind kind = Kind::kServe;
    config::Config config;
    service::HealthQuestion health;
    channel::OfflineJob job;
    channel::RecordJob record_job;
    InspectJob inspect_job;
    std::vector<std::string> problems; ///< of flags and config; empty: none
    std::string text;
};

/// Reads flags, or a --config file with the same names. The words "render", "record" and "inspect" in front select
/// another task than serving. Reads the files that flags name, but changes nothing.
Invocation read_flags(int argc, const char* const* argv);

} // namespace fieldcast::command_line
