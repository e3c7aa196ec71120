// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/fanout/message_loop.h"

#include <memory>

namespace fieldcast::bench::fanout {

/// The yardstick: a gRPC server that sends the same messages to whoever calls, whatever they call or say. At every
/// interval the next frame begins, for each client that has got all of the one before. Messages are shared slices;
/// nothing is serialised, counted, timed or acknowledged.
class BareServer {
public:
    /// On a free port of the loopback address.
    BareServer(const MessageLoop& loop, double frames_per_second);
    ~BareServer();
    BareServer(const BareServer&) = delete;
    BareServer& operator=(const BareServer&) = delete;

    int port() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::bench::fanout
