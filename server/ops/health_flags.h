// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/service/health_probe.h"

#include <string>

namespace fieldcast::ops {

/// What --health and the flags that go with it say.
struct HealthText {
    std::string server; ///< HOST:PORT or https://HOST:PORT; empty: not asked for
    std::string ca;
    std::string name;
    std::string token_file;
};

/// Throws UserError naming the flag. `certificate` and `key` are the server's own, shown to a server that asks for one.
service::HealthQuestion read_health(const HealthText& text, const std::string& certificate, const std::string& key);

} // namespace fieldcast::ops
