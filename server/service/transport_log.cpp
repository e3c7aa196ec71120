// SPDX-License-Identifier: Apache-2.0
#include "server/service/transport_log.h"

#include "core/base/log_quota.h"

#include <grpc/support/log.h>

namespace fieldcast::service {

namespace {

log::Level level_of(gpr_log_severity severity) {
    switch (severity) {
    case GPR_LOG_SEVERITY_DEBUG:
        return log::Level::kDebug;
    case GPR_LOG_SEVERITY_INFO:
        return log::Level::kInfo;
    case GPR_LOG_SEVERITY_ERROR:
        break;
    }
    return log::Level::kWarn;
}

void write_line(gpr_log_func_args* line) {
    // Never destroyed: threads of gRPC outlive main.
    static auto& lines = *new log::Quota("everybody", log::Quota::kOfEverybody);
    lines.write(level_of(line->severity), "transport", {{"message", line->message}});
}

} // namespace

void log_transport() {
    gpr_set_log_function(write_line);
}

} // namespace fieldcast::service
