// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/session/negotiate.h"

#include <string>
#include <vector>

namespace fieldcast::session {

/// One way to send less: the Configure that a client with less to ask for would have sent.
struct Rung {
    v1::Configure wanted;
    double cost = 1.0;  ///< bytes per second relative to what was asked for; an expectation
    std::string change; ///< from the rung before, for people
};

/// What a server may do about a bad connection, within `wanted.adaptation`, the least painful first: codec, quality,
/// frame rate, size of the views, number of views, delivery mode. Rung 0 is what was asked for and got `granted`; costs
/// fall.
std::vector<Rung> make_ladder(const v1::Configure& wanted, const Configuration& granted);

} // namespace fieldcast::session
