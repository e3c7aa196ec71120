// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/connection.h"

#include "fieldcast/v1/light_field.pb.h"

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

namespace fieldcast::client::net {

/// A message with the moment at which the transport delivered it, before it waited for us.
struct ReceivedMessage {
    v1::ServerMessage message;
    std::int64_t arrived_ns = 0;
};

/// How a stream is read. The defaults are those of a client that reads as fast as it can.
struct ReadingOptions {
    /// Called, by a thread of gRPC and under the stream's lock, when a message has come or the stream has ended: for
    /// one thread that looks after many streams. Must only note the fact and return.
    std::function<void()> on_change{};
    std::size_t max_waiting_bytes = 64U << 20; ///< received and not taken; then the transport makes the server wait
    double max_bytes_per_second = 0.0; ///< `next` gives no more than that on average: a slow reader; 0: no limit
};

/// One LightField.Open stream, as messages. Opened by the constructor; the destructor cuts it and waits for gRPC to let
/// go.
class MessageStream {
public:
    explicit MessageStream(const Connection& connection, ReadingOptions options = {});
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

    /// Before this moment `next` gives nothing: a slow reader is not done with the message before.
    std::chrono::steady_clock::time_point next_after() const { return next_after_; }

    /// Set once the stream is over and all its messages were taken. Its message is empty after an orderly end.
    std::optional<NetError> end() const;

    static constexpr std::size_t kMaxUnsent = 1024;

private:
    class Reactor;
    double max_bytes_per_second_;
    std::chrono::steady_clock::time_point next_after_{};
    std::unique_ptr<Reactor> reactor_;
};

} // namespace fieldcast::client::net
