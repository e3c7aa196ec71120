// SPDX-License-Identifier: Apache-2.0
#include "server/session/server_session.h"

#include "server/session/field_limits.h"

#include <algorithm>

namespace fieldcast::session {

namespace {

wire::WireChunk control_chunk(const v1::ServerMessage& message) {
    return {.head = message.SerializeAsString(), .owner = nullptr, .payload = {}};
}

} // namespace

ServerSession::ServerSession(std::vector<std::shared_ptr<feed::Feed>> channels, const Limits& limits,
                             feed::FrameCallback on_frame, TimePoint now, const PeerBudgets& budgets,
                             feed::Steerer steerer)
    : limits_(limits),
      messages_({.per_second = limits.max_messages_per_second, .burst = 2.0 * limits.max_messages_per_second}),
      next_heartbeat_(now + limits.heartbeat_interval), configure_by_(now + limits.configure_deadline),
      lines_(steerer.name), steering_(std::move(steerer), limits.max_poses_per_second, lines_),
      sender_(agreement_, counts_, limits.max_bytes_in_flight, budgets.bytes),
      agreement_(std::move(channels), limits, std::move(on_frame), budgets, steering_.may_steer()) {}

void ServerSession::on_message(const v1::ClientMessage& message, TimePoint now) {
    is_flooded_ = is_flooded_ || !messages_.take(now, message.has_configure() ? kConfigureWeight : 1.0);
    if (is_flooded_) {
        return;
    }
    switch (message.message_case()) {
    case v1::ClientMessage::kConfigure:
        return handle(message.configure(), now);
    case v1::ClientMessage::kFrameAck:
        return sender_.acknowledged(message.frame_ack(), now);
    case v1::ClientMessage::kTimeSync: {
        v1::TimeSyncResponse& answer = *answers_.emplace_back().mutable_time_sync();
        answer.set_client_send_ns(message.time_sync().client_send_ns());
        answer.set_server_receive_ns(nanoseconds_of(now));
        return;
    }
    case v1::ClientMessage::kRequestSteering:
        return steering_.handle(message.request_steering(), now);
    case v1::ClientMessage::kSteerCamera:
        return steering_.handle(message.steer_camera(), now);
    case v1::ClientMessage::kReleaseSteering:
        return steering_.release(now);
    case v1::ClientMessage::kOfferSteering:
        return steering_.offer(now);
    case v1::ClientMessage::MESSAGE_NOT_SET:
        return; // a kind that only newer clients send
    }
}

void ServerSession::on_bytes(std::size_t size, TimePoint now) {
    is_flooded_ = is_flooded_ || !messages_.take(now, static_cast<double>(size / kBytesPerMessage));
}

void ServerSession::end() {
    steering_.leave();
    agreement_.close();
    sender_.in_flight().end();
}

void ServerSession::handle(const v1::Configure& wanted, TimePoint now) {
    if (const auto oversized = oversized_field(wanted)) {
        return refuse(*oversized, wanted.request_id());
    }
    if (const auto refusal = agreement_.change(wanted)) {
        return refuse(*refusal, wanted.request_id());
    }
    request_id_ = wanted.request_id();
    const Configuration& granted = *agreement_.configuration();
    sender_.in_flight().adapter().configured(wanted, granted);
    begin_epoch();
    steering_.move_to(granted.feed->steering(), now);
}

void ServerSession::refuse(const Refusal& refusal, std::uint32_t request_id) {
    ++counts_.refusals;
    *answers_.emplace_back().mutable_refused() = to_message(refusal, request_id);
}

v1::Configured& ServerSession::begin_epoch() {
    if (auto aborted = sender_.begin_epoch()) {
        *answers_.emplace_back().mutable_frame_aborted() = std::move(*aborted);
    }
    v1::Configured& configured = *answers_.emplace_back().mutable_configured();
    configured = to_message(*agreement_.configuration(), request_id_, agreement_.epoch(), credits().limit());
    return configured;
}

void ServerSession::adapt(TimePoint now) {
    Adapter& adapter = sender_.in_flight().adapter();
    const auto change = is_leaving() ? std::nullopt : adapter.due(now);
    if (!change) {
        return;
    }
    if (agreement_.change(adapter.configure(*change))) { // refused, such as no room for views of another size
        adapter.refused();
        return;
    }
    *begin_epoch().mutable_adapted() = adapter.to_message(*change);
    ++(change->reason == LevelReason::kRecovered ? counts_.adaptations.up : counts_.adaptations.down);
}

void ServerSession::go_away(const std::string& reason, TimePoint at, CloseReason why) {
    if (!is_leaving()) {
        departure_ = Departure{.reason = reason, .at = at};
        close_reason_ = why;
        agreement_.freeze();
    }
    if (why == CloseReason::kRevoked) { // whether or not the client reads GoingAway
        const TimePoint latest = at + limits_.revoked_deadline;
        cut_at_ = cut_at_ ? std::min(*cut_at_, latest) : latest;
    }
}

void ServerSession::on_tick(TimePoint now) {
    adapt(now);
    if (!configuration() && now >= configure_by_) {
        go_away("no acceptable Configure within " + std::to_string(limits_.configure_deadline.count()) + " ms", now,
                CloseReason::kNotConfigured);
    }
    if (agreement_.has_camera_failed()) {
        go_away("the camera of this session failed; the server's log has the reason", now, CloseReason::kFailed);
    }
    const auto oldest = credits().oldest();
    if (oldest && now - *oldest >= limits_.stall_deadline) {
        go_away("a frame was not acknowledged within " + std::to_string(limits_.stall_deadline.count()) + " ms", now,
                CloseReason::kStalled);
    }
}

std::optional<wire::WireChunk> ServerSession::next(TimePoint now) {
    auto control = next_control(now);
    return control ? std::move(control) : sender_.next(now);
}

std::optional<wire::WireChunk> ServerSession::next_control(TimePoint now) {
    if (!answers_.empty()) {
        v1::ServerMessage answer = std::move(answers_.front());
        answers_.pop_front();
        if (answer.has_time_sync()) {
            answer.mutable_time_sync()->set_server_send_ns(nanoseconds_of(now));
        }
        return control_chunk(answer);
    }
    if (auto news = steering_.next(now)) {
        return control_chunk(*news);
    }
    if (departure_ && now >= departure_->at) {
        return control_chunk(depart(now));
    }
    if (now >= next_heartbeat_) {
        next_heartbeat_ = now + limits_.heartbeat_interval;
        v1::ServerMessage message = heartbeat();
        message.mutable_heartbeat()->set_server_time_ns(nanoseconds_of(now));
        return control_chunk(message);
    }
    return std::nullopt;
}

v1::ServerMessage ServerSession::depart(TimePoint now) {
    v1::ServerMessage message;
    v1::GoingAway& going_away = *message.mutable_going_away();
    going_away.set_reason(departure_->reason);
    departure_.reset();
    const TimePoint latest = now + limits_.going_away_deadline;
    cut_at_ = cut_at_ ? std::min(*cut_at_, latest) : latest;
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(*cut_at_ - now);
    going_away.set_deadline_ms(static_cast<std::uint32_t>(std::max(left.count(), std::int64_t{0})));
    steering_.leave();
    agreement_.close();
    sender_.drop_waiting(DropReason::kLeaving);
    return message;
}

v1::ServerMessage ServerSession::heartbeat() const {
    v1::ServerMessage message;
    v1::Heartbeat& heartbeat = *message.mutable_heartbeat();
    if (configuration()) {
        const feed::LatestFrame latest = configuration()->feed->latest();
        heartbeat.set_latest_frame_id(latest.frame_id);
        heartbeat.set_scene_time_ns(latest.scene_time_ns);
    }
    return message;
}

} // namespace fieldcast::session
