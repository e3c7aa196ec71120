// SPDX-License-Identifier: Apache-2.0
#include "client/net/client_session.h"

#include "core/base/printable.h"
#include "core/wire/convert.h"

#include <algorithm>

namespace fieldcast::client::net {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kSyncPeriod{1};
constexpr std::uint32_t kMostFailuresInARow = 16; // more: the server uses another protocol

Refused to_refused(const v1::Refused& message, bool was_change) {
    const bool is_transient = message.reason() == v1::REFUSAL_REASON_EXHAUSTED;
    const std::string field = message.field().empty() ? "" : printable(message.field()) + ": ";
    return {field + printable(message.message()), is_transient, was_change};
}

v1::ClientMessage to_ack(const FrameReport& report, v1::FrameOutcome outcome) {
    v1::ClientMessage message;
    v1::FrameAck& ack = *message.mutable_frame_ack();
    ack.set_frame_id(report.frame_id);
    ack.set_epoch(report.epoch);
    ack.set_outcome(outcome);
    ack.set_first_byte_ns(report.first_byte_ns);
    ack.set_last_byte_ns(report.last_byte_ns);
    ack.set_decoded_ns(report.decoded_ns);
    ack.set_rendered_ns(report.rendered_ns);
    ack.set_shown_ns(report.shown_ns);
    ack.set_times_shown(report.shown_ns != 0 ? 1 : 0);
    if (report.clock) {
        ack.mutable_clock()->set_server_minus_client_ns(report.clock->server_minus_client_ns);
        ack.mutable_clock()->set_round_trip_ns(report.clock->round_trip_ns);
    }
    return message;
}

} // namespace

ClientSession::ClientSession(const Connection& connection, const Request& request, WorkerPool& pool)
    : ClientSession(connection, request, pool, Options{}) {}

ClientSession::ClientSession(const Connection& connection, const Request& request, WorkerPool& pool, Options options)
    : stream_(connection, std::move(options.reading)), assembler_(&pool, options.decoding), next_sync_(Clock::now()),
      last_message_(Clock::now()) {
    configure(request);
}

void ClientSession::configure(const Request& request) {
    asked_.push_back({++last_request_id_, request});
    v1::ClientMessage message;
    *message.mutable_configure() = to_configure(request, last_request_id_);
    stream_.send(std::move(message));
}

std::optional<Event> ClientSession::next(Clock::time_point deadline) {
    while (!is_over_) {
        if (Clock::now() >= next_sync_) {
            send_time_sync();
        }
        const Clock::time_point silence_ends = last_message_ + kLongestSilence;
        if (auto received = stream_.next(std::min({deadline, next_sync_, silence_ends}))) {
            last_message_ = Clock::now();
            if (auto event = handle(std::move(*received))) {
                return event;
            }
        } else if (auto end = stream_.end()) {
            is_over_ = true;
            return Ended{std::move(*end)};
        } else if (Clock::now() >= silence_ends) {
            is_over_ = true;
            return Ended{NetError("the server has been silent for too long", true)};
        } else if (Clock::now() >= deadline) {
            return std::nullopt;
        }
    }
    return std::nullopt;
}

Clock::time_point ClientSession::next_call() const {
    const Clock::time_point reads_on = stream_.next_after();
    const Clock::time_point watch = std::min(next_sync_, last_message_ + kLongestSilence);
    return reads_on > Clock::now() ? std::min(reads_on, watch) : watch;
}

void ClientSession::report(const FrameReport& report) {
    stream_.send(to_ack(report, report.was_superseded ? v1::FRAME_OUTCOME_SUPERSEDED : v1::FRAME_OUTCOME_DECODED));
}

void ClientSession::send_time_sync() {
    v1::ClientMessage message;
    message.mutable_time_sync()->set_client_send_ns(steady_now_ns());
    stream_.send(std::move(message));
    next_sync_ = Clock::now() + kSyncPeriod;
}

std::optional<Event> ClientSession::handle(ReceivedMessage received) {
    v1::ServerMessage& message = received.message;
    switch (message.message_case()) {
    case v1::ServerMessage::kConfigured:
        return handle_configured(message.configured());
    case v1::ServerMessage::kRefused:
        return handle_refused(message.refused());
    case v1::ServerMessage::kFrameChunk:
        return handle_chunk(std::move(received));
    case v1::ServerMessage::kFrameAborted:
        assembler_.abort(message.frame_aborted().frame_id());
        return FrameAborted{};
    case v1::ServerMessage::kTimeSync:
        clock_.add({message.time_sync().client_send_ns(), message.time_sync().server_receive_ns(),
                    message.time_sync().server_send_ns(), received.arrived_ns});
        return std::nullopt;
    case v1::ServerMessage::kGoingAway:
        return GoingAway{std::chrono::milliseconds(message.going_away().deadline_ms()),
                         printable(message.going_away().reason())};
    case v1::ServerMessage::kSteeringGranted:
        return to_news(message.steering_granted());
    case v1::ServerMessage::kSteeringDenied:
        return to_news(message.steering_denied());
    case v1::ServerMessage::kSteeringReleased:
        return to_news(message.steering_released());
    case v1::ServerMessage::kHeartbeat:      // only its arrival matters
    case v1::ServerMessage::MESSAGE_NOT_SET: // a kind of message newer than this program
        return std::nullopt;
    }
    return std::nullopt;
}

Event ClientSession::broken(const std::string& what) {
    is_over_ = true;
    return Ended{NetError(what, false)};
}

std::optional<Event> ClientSession::handle_configured(const v1::Configured& message) {
    if (agreement_ && message.epoch() <= agreement_->epoch) {
        return broken("Configured: the epoch is not newer than the current one");
    }
    if (message.has_adapted()) {
        return handle_adapted(message);
    }
    if (asked_.empty() || message.request_id() != asked_.front().request_id) {
        return broken("Configured without a matching request");
    }
    Decoded<Agreement> agreement = from_configured(message, asked_.front().request);
    if (!agreement) {
        return broken(agreement.error().message);
    }
    request_ = std::move(asked_.front().request);
    granted_request_id_ = asked_.front().request_id;
    asked_.pop_front();
    return begin_epoch(std::move(*agreement));
}

std::optional<Event> ClientSession::handle_adapted(const v1::Configured& message) {
    if (!agreement_ || message.request_id() != granted_request_id_ || message.channel() != agreement_->channel) {
        return broken("Configured: adapted, but not from the granted configuration");
    }
    Decoded<Agreement> agreement = from_configured(message, request_);
    if (!agreement) {
        return broken(agreement.error().message);
    }
    agreement->adapted->change = printable(agreement->adapted->change);
    return begin_epoch(std::move(*agreement));
}

Event ClientSession::begin_epoch(Agreement agreement) {
    agreement_ = std::move(agreement);
    assembler_.begin_epoch(agreement_->epoch, agreement_->limits);
    return *agreement_;
}

std::optional<Event> ClientSession::handle_refused(const v1::Refused& message) {
    if (asked_.empty() || message.request_id() != asked_.front().request_id) {
        return broken("Refused without a matching request");
    }
    asked_.pop_front();
    return to_refused(message, agreement_.has_value());
}

std::optional<Event> ClientSession::handle_chunk(ReceivedMessage received) {
    if (!agreement_) {
        return broken("a frame before Configured");
    }
    v1::FrameChunk& chunk = *received.message.mutable_frame_chunk();
    const std::uint64_t frame_id = chunk.frame_id();
    const std::uint32_t epoch = chunk.epoch();
    if (chunk.content_case() == v1::FrameChunk::kHeader) {
        first_byte_ns_ = received.arrived_ns;
    }
    Decoded<std::optional<wire::ReceivedFrame>> added = assembler_.add(std::move(chunk));
    if (!added) {
        return failed_frame(frame_id, epoch, added.error().message);
    }
    if (!*added) {
        return std::nullopt;
    }
    if (const auto problem = frame_problem(**added, *agreement_)) {
        return failed_frame(frame_id, epoch, *problem);
    }
    return arrived_frame(std::move(**added), received.arrived_ns);
}

Event ClientSession::failed_frame(std::uint64_t frame_id, std::uint32_t epoch, std::string reason) {
    if (++failures_in_a_row_ >= kMostFailuresInARow) {
        return broken("too many undecodable frames, the last one: " + reason);
    }
    FrameReport report;
    report.frame_id = frame_id;
    report.epoch = epoch;
    stream_.send(to_ack(report, v1::FRAME_OUTCOME_FAILED));
    return FrameFailed{std::move(reason)};
}

Event ClientSession::arrived_frame(wire::ReceivedFrame frame, std::int64_t last_byte_ns) {
    failures_in_a_row_ = 0;
    FrameArrived arrived;
    arrived.frame_id = frame.header().frame_id;
    arrived.first_byte_ns = first_byte_ns_;
    arrived.last_byte_ns = last_byte_ns;
    arrived.decoded_ns = steady_now_ns();
    arrived.pose_sampled_ns = clock_.client_from_server_ns(frame.server_times.pose_sampled_ns);
    arrived.send_begin_ns = clock_.client_from_server_ns(frame.server_times.send_begin_ns);
    arrived.clock = clock_.offset();
    FrameReport report;
    report.frame_id = arrived.frame_id;
    report.epoch = frame.epoch;
    report.first_byte_ns = arrived.first_byte_ns;
    report.last_byte_ns = arrived.last_byte_ns;
    report.decoded_ns = arrived.decoded_ns;
    report.clock = arrived.clock;
    stream_.send(to_ack(report, v1::FRAME_OUTCOME_DECODED));
    arrived.frame = std::move(frame);
    return arrived;
}

} // namespace fieldcast::client::net
