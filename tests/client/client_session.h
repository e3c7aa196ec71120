// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/client_session.h"
#include "tests/client/fake_server.h"

#include <gtest/gtest.h>

namespace fieldcast::test {

inline client::net::Request small_request() {
    client::net::Request request;
    request.rows = 1;
    request.cols = 2;
    return request;
}

/// A session with a fake server; every wait has a deadline.
class SessionTest : public testing::Test {
protected:
    void open(FakeServer::Script script, const client::net::Request& request = small_request()) {
        server_.emplace(std::move(script));
        connection_.emplace(server_->address());
        session_.emplace(*connection_, request, pool_);
    }

    /// The next event of that kind; others are skipped.
    template <class Kind> std::optional<Kind> next() {
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (auto event = session_->next(deadline)) {
            if (auto* wanted = std::get_if<Kind>(&*event)) {
                return std::move(*wanted);
            }
        }
        return std::nullopt;
    }

    WorkerPool pool_{1};
    std::optional<FakeServer> server_;
    std::optional<client::net::Connection> connection_;
    std::optional<client::net::ClientSession> session_;
};

} // namespace fieldcast::test
