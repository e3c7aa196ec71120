// SPDX-License-Identifier: Apache-2.0
#include "server/web/route.h"

#include "core/base/log.h"

#include <algorithm>

namespace fieldcast::web {

namespace {

Answer say(int status, const std::string& text) {
    return {.status = status, .body = text + "\n"};
}

std::string paths_of(const std::vector<Route>& routes) {
    std::string text;
    for (const Route& route : routes) {
        text += (text.empty() ? "" : ", ") + route.path;
    }
    return text;
}

/// Calls the route's handler; its exceptions go to the log, not to the caller.
Answer answer_of(const Route& route, const Request& request) {
    try {
        return route.get(request);
    } catch (const std::exception& problem) {
        log::warn("page failed", {{"path", route.path}, {"problem", problem.what()}});
        return say(500, "the page failed; see the log of the server");
    }
}

} // namespace

Answer respond(const Request& request, const std::vector<Route>& routes, const access::Gate* gate) {
    const auto route = std::ranges::find(routes, request.path, &Route::path);
    const bool is_known = route != routes.end();
    if (gate != nullptr) {
        const access::Role needed = is_known ? route->role : access::Role::kAdmin;
        const auto identity = gate->admit(request.authorization, request.path, needed);
        if (!identity) {
            const bool is_caller_known = identity.error().kind == access::Denial::Kind::kRoleTooLow;
            return say(is_caller_known ? 403 : 401, identity.error().message);
        }
    }
    if (request.method != "GET" && request.method != "HEAD") {
        return say(405, "use GET or HEAD");
    }
    return is_known ? answer_of(*route, request) : say(404, "unknown page; available: " + paths_of(routes));
}

} // namespace fieldcast::web
