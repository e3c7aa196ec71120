// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/access/gate.h"
#include "server/web/message.h"

#include <functional>
#include <vector>

namespace fieldcast::web {

/// A path that can be asked for with GET and HEAD.
struct Route {
    std::string path;
    access::Role role = access::Role::kAdmin; ///< the least that may ask, where tokens are asked for
    std::function<Answer(const Request&)> get;
};

/// What a request gets. Without `gate` everybody may ask; paths without a route need the highest role.
Answer respond(const Request& request, const std::vector<Route>& routes, const access::Gate* gate);

} // namespace fieldcast::web
