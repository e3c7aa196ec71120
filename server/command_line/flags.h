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

/// What the command line asks for.
struct Invocation {
    enum class Kind : std::uint8_t {
        kServe,
        kPrint,   ///< only print `text`: --help, --version, --print-config, --make-token
        kCheck,   ///< only validate
        kHealth,  ///< only ask the server of `health`
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
    std::vector<std::string> problems; ///< with the flags or the config; empty: nothing is wrong
    std::string text;
};

/// Reads flags, or a --config file with the same names. "render", "record" or "inspect" in front asks for files or
/// a report instead of a service. Reads files that flags name, changes nothing.
Invocation read_flags(int argc, const char* const* argv);

} // namespace fieldcast::command_line
