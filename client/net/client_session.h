// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/clock_sync.h"
#include "client/net/configure.h"
#include "client/net/message_stream.h"
#include "client/net/steering.h"
#include "core/base/parallel.h"
#include "core/wire/frame_assembler.h"

#include <atomic>
#include <chrono>
#include <deque>
#include <optional>
#include <string>
#include <variant>

namespace fieldcast::client::net {

/// A complete frame that matches the agreement, with its times on our steady clock.
struct FrameArrived {
    wire::ReceivedFrame frame;
    std::uint64_t frame_id = 0; ///< remains valid when the content of `frame` is moved away
    std::int64_t first_byte_ns = 0;
    std::int64_t last_byte_ns = 0;
    std::int64_t decoded_ns = 0;
    std::optional<std::int64_t> pose_sampled_ns; ///< server's time on our clock, if known
    std::optional<std::int64_t> send_begin_ns;
    std::optional<ClockSync::Offset> clock; ///< estimate at the time of its arrival
};

/// A frame that could not be decoded, or does not match the agreement.
struct FrameFailed {
    std::string reason;
};

/// The server has abandoned a frame that it had begun.
struct FrameAborted {};

/// The server has refused a request.
struct Refused {
    std::string message;
    bool is_transient = false; ///< the server may grant it later
    bool was_change = false;   ///< an earlier agreement stays in force
};

/// The server is shutting down. The client should half-close before the deadline and connect elsewhere or later.
struct GoingAway {
    std::chrono::milliseconds deadline{0};
    std::string reason;
};

/// The last event of a session. The error's message is empty after an orderly end.
struct Ended {
    NetError error;
};

using Event = std::variant<Agreement, FrameArrived, FrameFailed, FrameAborted, Refused, GoingAway, SteeringNews, Ended>;

/// The fate of a decoded frame.
struct FrameReport {
    std::uint64_t frame_id = 0;
    std::uint32_t epoch = 0;
    bool was_superseded = false; ///< not shown, because a newer one was complete
    std::int64_t first_byte_ns = 0;
    std::int64_t last_byte_ns = 0;
    std::int64_t decoded_ns = 0;
    std::int64_t rendered_ns = 0; ///< mode kScene
    std::int64_t shown_ns = 0;
    std::optional<ClockSync::Offset> clock; ///< with which the server converts these times to its own clock
};

/// One stream: requests configurations, decodes and acknowledges frames, synchronises the clocks. Checks every message
/// of the server. `next` must always be called on the same thread; `report`, `send` and `half_close` on any.
class ClientSession {
public:
    struct Options {
        wire::Decoding decoding = wire::Decoding::kFull; ///< otherwise frames have no pixels
        ReadingOptions reading{};
    };

    /// `pool` decodes and must outlive this.
    ClientSession(const Connection& connection, const Request& request, WorkerPool& pool);
    ClientSession(const Connection& connection, const Request& request, WorkerPool& pool, Options options);

    /// Requests another configuration on the running stream. The answer is Refused, or an Agreement, after which all
    /// frames have the new configuration. For the thread that calls `next`. At most `kMaxUnanswered` may be unanswered.
    void configure(const Request& request);
    bool may_configure() const { return asked_.size() < kMaxUnanswered; }
    static constexpr std::size_t kMaxUnanswered = 8;

    /// The next event, or nothing if none occurs before `deadline`. Ended is the last event.
    std::optional<Event> next(std::chrono::steady_clock::time_point deadline);

    /// The time at which `next` must be called again even if no message has arrived: to synchronise the clocks, to
    /// detect a silent server, or to continue slow reading.
    std::chrono::steady_clock::time_point next_call() const;

    /// Sends a second acknowledgement, with the times that the first could not contain. It returns no credit.
    void report(const FrameReport& report);

    /// A message of steering.h.
    void send(v1::ClientMessage message) { stream_.send(std::move(message)); }

    void half_close() { stream_.half_close(); }
    const ClockSync& clock() const { return clock_; } ///< for the thread that calls `next`

    /// Silence after which the session ends. Heartbeats come twice a second, even while a slow server renders.
    static constexpr std::chrono::seconds kLongestSilence{20};

private:
    std::optional<Event> handle(ReceivedMessage received);
    std::optional<Event> handle_configured(const v1::Configured& message);
    std::optional<Event> handle_adapted(const v1::Configured& message);
    Event begin_epoch(Agreement agreement);
    std::optional<Event> handle_refused(const v1::Refused& message);
    std::optional<Event> handle_chunk(ReceivedMessage received);
    Event failed_frame(std::uint64_t frame_id, std::uint32_t epoch, std::string reason);
    Event arrived_frame(wire::ReceivedFrame frame, std::int64_t last_byte_ns);
    void send_time_sync();
    Event broken(const std::string& what);

    /// A Configure that the server has not answered yet.
    struct Asked {
        std::uint32_t request_id = 0;
        Request request;
    };

    std::deque<Asked> asked_; ///< oldest first, which is also the order of the answers
    std::uint32_t last_request_id_ = 0;
    std::uint32_t granted_request_id_ = 0;
    Request request_; ///< granted
    MessageStream stream_;
    wire::FrameAssembler assembler_;
    ClockSync clock_;
    std::optional<Agreement> agreement_;
    std::chrono::steady_clock::time_point next_sync_;
    std::chrono::steady_clock::time_point last_message_;
    std::int64_t first_byte_ns_ = 0; ///< of the frame in progress
    std::uint32_t failures_in_a_row_ = 0;
    bool is_over_ = false;
};

} // namespace fieldcast::client::net
