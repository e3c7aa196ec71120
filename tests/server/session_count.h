// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/service/grpc_server.h"
#include "tests/fixtures/polling.h"

namespace fieldcast::test {

/// Whether the server comes to have `count` sessions: a client learns that its call has ended a little before the
/// server has forgotten the session.
inline bool comes_to_sessions(service::GrpcServer& server, std::size_t count) {
    constexpr std::chrono::seconds kPatience{20}; // far more than any machine needs
    return comes_true([&] { return server.session_count() == count; }, kPatience);
}

} // namespace fieldcast::test
