// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/configure.h"
#include "client/play/change.h"

#include <string>

namespace fieldcast::client {

/// Reads "WHEN:KEY=VALUE,KEY=VALUE…" on top of what was asked for before. WHEN is a time since the stream was granted
/// ("3s", "500ms") or a number of frames that have come ("20f"). Keys are those of
/// net::request_setters(). Throws UserError that names the flag and the key.
play::Change read_change(const std::string& text, const net::Request& before);

/// Reads "KEY=VALUE,KEY=VALUE…": what the server may change by itself. Keys are those of
/// net::adaptation_setters(). Throws UserError.
net::AdaptationBounds read_adaptation(const std::string& text);

/// A flag of a request, by its name without the dashes. Throws UserError that names flag and value.
void set_in_request(const std::string& key, const std::string& value, net::Request& request);

} // namespace fieldcast::client
