// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/configure.h"
#include "client/play/change.h"

#include <string>

namespace fieldcast::client {

/// Reads "WHEN:KEY=VALUE,KEY=VALUE…" and applies the values to a copy of `before`. WHEN is a time since the server
/// accepted the stream ("3s", "500ms") or a number of received frames ("20f"). Keys are those of
/// net::request_setters(). Throws UserError that names the flag and the key.
play::Change read_change(const std::string& text, const net::Request& before);

/// Reads "KEY=VALUE,KEY=VALUE…", the bounds within which the server may adapt the stream. Keys are those of
/// net::adaptation_setters(). Throws UserError that names the flag and the key.
net::AdaptationBounds read_adaptation(const std::string& text);

/// Sets one field of `request`; `key` is the name of its flag without the dashes. Throws UserError that names the flag
/// and the value.
void set_in_request(const std::string& key, const std::string& value, net::Request& request);

} // namespace fieldcast::client
