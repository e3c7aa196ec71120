// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/fanout/message_loop.h"

#include <memory>

namespace fieldcast::bench::fanout {

/// The baseline: a gRPC server that sends the same messages to every caller, independent of its requests. At every
/// interval it starts the next frame for each client that has received all of the previous one. Messages are shared
/// slices; nothing is serialised, counted, timed or acknowledged.
class BareServer {
public:
    /// Listens on a free port of the loopback address.
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
