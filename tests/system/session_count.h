// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/service/grpc_server.h"

#include <chrono>
#include <thread>

namespace fieldcast::test {

/// Whether the server comes to have `count` sessions: a client learns that its call has ended a little before the
/// server has forgotten the session.
inline bool comes_to_sessions(service::GrpcServer& server, std::size_t count) {
    const auto deadline =
        std::chrono::steady_clock::now() + std::chrono::seconds{20}; // far more than any machine needs
    while (server.session_count() != count && std::chrono::steady_clock::now() < deadline) {
        std::this_thread::sleep_for(std::chrono::milliseconds{5}); // the count has no event to wait for
    }
    return server.session_count() == count;
}

} // namespace fieldcast::test
