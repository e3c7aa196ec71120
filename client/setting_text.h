// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/configure.h"
#include "client/play/change.h"

#include <string>

namespace fieldcast::client {

/// Reads "WHEN:KEY=VALUE,KEY=VALUE…" on top of what was asked for before. WHEN is a time since the stream was granted
/// ("3s", "500ms") or a number of frames that have come ("20f"). Keys are flags of the command line without their
/// dashes: grid, size, spacing, convergence, fov, anchor, mode, planes, codec (several with +), quality, max-fps.
/// Throws UserError that names the flag and the key.
play::Change read_change(const std::string& text, const net::Wish& before);

/// Reads "KEY=VALUE,KEY=VALUE…": what the server may change by itself. Keys: jpeg (on, off), quality, fps, height, grid
/// (the least of each; 0 or 0x0: no change of that kind), scene (on, off), delay (ms). Throws UserError.
net::AdaptationWish read_adaptation(const std::string& text);

/// The same values as the flags take. Throw UserError, which begins with `what`.
void set_grid(const std::string& what, const std::string& text, net::Wish& wish);
void set_size(const std::string& what, const std::string& text, net::Wish& wish);
float rate_bound(const std::string& what, const std::string& text); ///< frames per second; 0: no bound
net::PlaneWish planes_of(const std::string& what, const std::string& word);
net::Mode mode_of(const std::string& what, const std::string& word);
codec::CodecId codec_of(const std::string& what, const std::string& word);

} // namespace fieldcast::client
