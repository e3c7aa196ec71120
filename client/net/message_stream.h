// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/connection.h"
#include "client/net/net_error.h"

#include "fieldcast/v1/light_field.pb.h"

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

namespace fieldcast::client::net {

/// A message, and the time at which the transport delivered it, on our steady clock.
struct ReceivedMessage {
    v1::ServerMessage message;
    std::int64_t arrived_ns = 0;
};

/// How a stream is read. The defaults are for a client that reads as fast as it can.
struct ReadingOptions {
    /// Called when a message has arrived or the stream has ended, on a thread of gRPC and under the stream's lock. It
    /// must only record the fact and return. Meant for programs in which one thread serves many streams.
    std::function<void()> on_change{};
    std::size_t max_waiting_bytes = 64U << 20; ///< received but not taken; beyond, the transport stops the server
    double max_bytes_per_second = 0.0; ///< average rate of `next`, to imitate slow readers; 0: no limit
};

/// The messages of one LightField.Open stream. The constructor opens the stream; the destructor cancels it and waits
/// until gRPC has finished with it.
class MessageStream {
public:
    explicit MessageStream(const Connection& connection, ReadingOptions options = {});
    ~MessageStream();
    MessageStream(const MessageStream&) = delete;
    MessageStream& operator=(const MessageStream&) = delete;

    /// Queues `message` behind those sent before and returns at once. Drops it if the stream has ended or was
    /// half-closed. The stream ends if more than `kMaxUnsent` messages wait, because the server does not read.
    /// Thread-safe.
    void send(v1::ClientMessage message);

    /// Ends our side after the queued messages. The server answers by ending its side. Thread-safe.
    void half_close();

    /// The next message; nothing if none arrives before `deadline` or the stream has ended. For one thread at a time.
    std::optional<ReceivedMessage> next(std::chrono::steady_clock::time_point deadline);

    /// The time before which `next` returns nothing, because of `max_bytes_per_second`.
    std::chrono::steady_clock::time_point next_after() const { return next_after_; }

    /// Set once the stream has ended and all its messages were taken. Its message is empty after an orderly end.
    std::optional<NetError> end() const;

    static constexpr std::size_t kMaxUnsent = 1024;

private:
    class Reactor;
    double max_bytes_per_second_;
    std::chrono::steady_clock::time_point next_after_{};
    std::unique_ptr<Reactor> reactor_;
};

} // namespace fieldcast::client::net
