// SPDX-License-Identifier: Apache-2.0
#include "server/service/transport_log.h"

#include "core/base/guarded.h"
#include "core/base/log.h"
#include "core/base/rate_limit.h"

#include <grpc/support/log.h>

namespace fieldcast::service {

namespace {

constexpr RateLimit::Rate kRate{.per_second = 1.0, .burst = 20.0};

void write_line(gpr_log_func_args* line) {
    static Guarded<RateLimit> rate{RateLimit(kRate)};
    if (!rate.lock()->take(std::chrono::steady_clock::now())) {
        return;
    }
    switch (line->severity) {
    case GPR_LOG_SEVERITY_DEBUG:
        return log::debug("transport", {{"message", line->message}});
    case GPR_LOG_SEVERITY_INFO:
        return log::info("transport", {{"message", line->message}});
    case GPR_LOG_SEVERITY_ERROR:
        return log::warn("transport", {{"message", line->message}});
    }
}

} // namespace

void log_transport() {
    gpr_set_log_function(write_line);
}

} // namespace fieldcast::service
