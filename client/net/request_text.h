// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/configure.h"
#include "client/net/setting.h"

#include <string>

// Reads requests from text: flags of `fieldcast-client`, its --change, and groups of `fieldcast-load`.
namespace fieldcast::client::net {

/// Settings of a request, named as their flags without the dashes: anchor, channel, codec (several with +),
/// convergence, fov (degrees), grid, max-fps, mode, normal-bits, planes, quality, residual (on, off), size, spacing.
const Setters<Request>& request_setters();

/// Settings of AdaptationBounds: the minimum of each; 0 or 0x0: no change of that kind. `delay` is a maximum, in ms.
const Setters<AdaptationBounds>& adaptation_setters();

} // namespace fieldcast::client::net
