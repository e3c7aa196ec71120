// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/access/access_watch.h"
#include "server/ops/flag_text.h"

namespace CLI {
class App;
}

namespace fieldcast::ops {

/// Certificates, tokens, and which dangers are accepted.
void add_security_flags(CLI::App& app, FlagText& text, access::Security& security);

} // namespace fieldcast::ops
