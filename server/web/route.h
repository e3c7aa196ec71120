// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/access/gate.h"
#include "server/web/message.h"

#include <functional>
#include <vector>

namespace fieldcast::web {

/// A path that answers GET and HEAD.
struct Route {
    std::string path;
    access::Role role = access::Role::kAdmin; ///< lowest role that may request it, if tokens are required
    std::function<Answer(const Request&)> get;
};

/// The answer to a request. Without `gate` all callers are admitted; paths without a route need the highest role.
Answer respond(const Request& request, const std::vector<Route>& routes, const access::Gate* gate);

} // namespace fieldcast::web
