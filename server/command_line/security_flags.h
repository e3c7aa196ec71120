// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/access/access_watch.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fieldcast::command_line {

/// Flags about certificates and tokens, as they were typed. Empty: not given.
struct SecurityText {
    std::string tls_cert;
    std::string tls_key;
    std::string tls_client_ca;
    std::string tokens;
};

void add_security_flags(CLI::App& app, SecurityText& text, access::Security& security);

/// Fills `security` from `text`; adds a line to `problems` for flags that need another one.
void read_security(const SecurityText& text, access::Security& security, std::vector<std::string>& problems);

} // namespace fieldcast::command_line
