// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/connection.h"

#include "fieldcast/v1/light_field.pb.h"

#include <chrono>
#include <memory>
#include <optional>

namespace fieldcast::client::net {

/// A message with the moment at which the transport delivered it, before it waited for us.
struct ReceivedMessage {
    v1::ServerMessage message;
    std::int64_t arrived_ns = 0;
};

/// One LightField.Open stream, as messages. Opened by the constructor; the destructor cuts it and waits for gRPC to let
/// go. Messages wait in a queue of at most 64 MiB (then the transport makes the server wait).
class MessageStream {
public:
    explicit MessageStream(const Connection& connection);
    ~MessageStream();
    MessageStream(const MessageStream&) = delete;
    MessageStream& operator=(const MessageStream&) = delete;

    /// Sends after everything sent before; returns at once. Dropped if the stream has ended or was half-closed.
    /// A server that reads nothing ends the stream: more than `kMaxUnsent` messages wait. Thread-safe.
    void send(v1::ClientMessage message);

    /// Ends our side after what was sent. The server answers by ending its own. Thread-safe.
    void half_close();

    /// The next message; nothing if none came until `deadline` or the stream has ended. One thread at a time.
    std::optional<ReceivedMessage> next(std::chrono::steady_clock::time_point deadline);

    /// Set once the stream is over and all its messages were taken. Its message is empty after an orderly end.
    std::optional<NetError> end() const;

    static constexpr std::size_t kMaxUnsent = 1024;
    static constexpr std::size_t kMaxWaitingBytes = 64U << 20;

private:
    class Reactor;
    std::unique_ptr<Reactor> reactor_;
};

} // namespace fieldcast::client::net
