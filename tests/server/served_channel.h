// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "server/service/grpc_server.h"
#include "tests/server/server_client.h"
#include "tests/server/synthetic.h"

#include <condition_variable>
#include <gmock/gmock.h>
#include <string>
#include <thread>

namespace fieldcast::test {

/// A synthetic channel behind a gRPC server on loopback, and the server's metrics.
class ServedChannel {
public:
    explicit ServedChannel(const session::Limits& limits);

    int port() const { return server_.port(); }
    service::GrpcServer& server() { return server_; }
    const std::shared_ptr<feed::Feed>& feed() const { return channel_.feed(); }
    std::string page() { return registry_->page().text(); }

    /// The value of a series, labels included; -1 if it is not there.
    double metric(const std::string& series);

    /// Waits until the series has that value: sessions end a moment after their client has seen the end.
    testing::AssertionResult shows(const std::string& series, double value);

private:
    SyntheticChannel channel_;
    const std::shared_ptr<metrics::Registry> registry_ = std::make_shared<metrics::Registry>();
    service::GrpcServer server_;
};

/// A client that behaves, in a thread of its own: reads, acknowledges, and half-closes at the end.
class Bystander {
public:
    explicit Bystander(int port);
    ~Bystander();
    Bystander(const Bystander&) = delete;
    Bystander& operator=(const Bystander&) = delete;

    /// Waits until it has got some more frames.
    testing::AssertionResult gets_more_frames();

private:
    void watch(const std::stop_token& stop);

    const std::shared_ptr<grpc::Channel> connection_;
    std::condition_variable came_;
    Guarded<std::uint64_t> frames_;
    std::jthread thread_;
};

} // namespace fieldcast::test
