// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/configure.h"
#include "client/net/setting.h"

#include <string>

// The one reader of what a client wants: flags of `fieldcast-client`, its --change, groups of `fieldcast-load`.
namespace fieldcast::client::net {

/// Settings of a request by the names that they have as flags, without the dashes: anchor, channel, codec (several with
/// +), convergence, fov (degrees), grid, max-fps, mode, normal-bits, planes, quality, residual (on, off), size, spacing.
const Setters<Request>& request_setters();

/// Of AdaptationBounds: the least of each; 0 or 0x0: no change of that kind.
const Setters<AdaptationBounds>& adaptation_setters();

} // namespace fieldcast::client::net
