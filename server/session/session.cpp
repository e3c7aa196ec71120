// SPDX-License-Identifier: Apache-2.0
#include "server/session/session.h"


#include <algorithm>
#include <array>

namespace fieldcast::session {

namespace {

using std::chrono::nanoseconds;

std::int64_t nanoseconds_of(TimePoint time) {
    return std::chrono::duration_cast<nanoseconds>(time.time_since_epoch()).count();
}

wire::WireChunk control_chunk(const v1::ServerMessage& message) {
    return {.head = message.SerializeAsString(), .owner = nullptr, .payload = {}};
}

/// Time that the client says it spent on decoding after the last byte; its clock is not ours.
nanoseconds decode_time(const v1::FrameAck& ack) {
    const bool is_known = ack.last_byte_ns() > 0 && ack.decoded_ns() > ack.last_byte_ns();
    return nanoseconds(is_known ? ack.decoded_ns() - ack.last_byte_ns() : 0);
}

} // namespace

Session::Session(std::vector<std::shared_ptr<feed::Feed>> channels, const Limits& limits, feed::FrameCallback on_frame,
                 TimePoint now, const PeerBudgets& budgets, feed::Steerer steerer)
    : channels_(std::move(channels)), limits_(limits), on_frame_(std::move(on_frame)),
      credits_(1.0, limits.max_bytes_in_flight), bytes_(budgets.bytes), pixels_(budgets.pixels),
      cameras_(budgets.cameras),
      messages_({.per_second = limits.max_messages_per_second, .burst = 2.0 * limits.max_messages_per_second}),
      next_heartbeat_(now + limits.heartbeat_interval),
      configure_by_(now + limits.configure_deadline),
      lines_(steerer.name), steering_(std::move(steerer), limits.max_poses_per_second, lines_) {}

void Session::on_message(const v1::ClientMessage& message, TimePoint now) {
    is_flooded_ = is_flooded_ || !messages_.take(now, message.has_configure() ? kConfigureWeight : 1.0);
    if (is_flooded_) {
        return;
    }
    switch (message.message_case()) {
    case v1::ClientMessage::kConfigure:
        return handle(message.configure(), now);
    case v1::ClientMessage::kFrameAck:
        return handle(message.frame_ack(), now);
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
        return; // a kind that a newer client knows
    }
}

void Session::on_bytes(std::size_t size, TimePoint now) {
    is_flooded_ = is_flooded_ || !messages_.take(now, static_cast<double>(size / kBytesPerMessage));
}

void Session::end() {
    steering_.leave();
    timings_.end();
    close_feeds();
    bytes_.resize(0);
}

void Session::close_feeds() {
    subscription_.end();
    own_feed_.close();
    cameras_.resize(0);
    pixels_.resize(0);
}

void Session::handle(const v1::FrameAck& ack, TimePoint now) {
    const bool is_first =
        credits_.acknowledged({.epoch = ack.epoch(), .frame_id = ack.frame_id()}, decode_time(ack), now);
    bytes_.resize(credits_.bytes_in_flight());
    timings_.acknowledged(ack);
    adapter_.acknowledged(ack, decode_time(ack), now);
    if (is_first && ack.outcome() == v1::FRAME_OUTCOME_FAILED) {
        ++counts_.frames_failed;
        if (ack.epoch() == epoch_) {
            set_key_frame(0); // it may have been that one, or one that referred to what the client does not have
        }
    }
}

void Session::on_frame(const feed::FramePtr& frame, TimePoint now) {
    if (!configuration_) {
        return;
    }
    const TimePoint begun = frame->begun.value_or(now);
    const bool had_room = !is_full_ && begun >= has_room_since_;
    const bool is_covered = feed::covers(*frame, configuration_->selection);
    if (!is_covered && !had_room) {
        return miss_frame(*frame, is_full_ ? waiting_reason() : full_because_);
    }
    if (!pace_.is_due(begun)) {
        return miss_frame(*frame, DropReason::kRateCap);
    }
    if (!is_covered) {
        if (epoch_ > 1) { // otherwise it was begun before the client came, and is none of its frames
            counts_.drops.add(DropReason::kReconfigured);
        }
        return;
    }
    pace_.take(begun);
    if (const auto older = mailbox_.put(frame)) {
        miss_frame(**older, waiting_reason());
    }
    if (sending_ || !credits_.allow(0)) {
        tell_room(now);
    }
}

DropReason Session::waiting_reason() const {
    return sending_ ? DropReason::kSending : lacks_budget_ ? DropReason::kNoBudget : DropReason::kNoCredit;
}

void Session::miss_frame(const feed::EncodedFrame& frame, DropReason reason) {
    counts_.drops.add(reason);
    if (reason != DropReason::kRateCap) {
        adapter_.missed();
    }
    if (frame.key_frame_id != 0 && frame.key_frame_id == frame.header.frame_id) {
        set_key_frame(0); // what follows refers to it
    }
}

void Session::tell_room(TimePoint now) {
    const bool is_full = mailbox_.peek() != nullptr;
    if (is_full == is_full_) {
        return;
    }
    is_full_ = is_full;
    if (is_full) {
        full_because_ = waiting_reason();
    } else {
        has_room_since_ = now;
    }
    if (subscription_.feed() != nullptr) {
        subscription_.set_room({.taken_until = is_full ? std::optional(rhythm_.next(now)) : std::nullopt});
    }
}

void Session::go_away(const std::string& reason, TimePoint at, CloseReason why) {
    if (!departure_ && !cut_at_) {
        departure_ = Departure{.reason = reason, .at = at};
        close_reason_ = why;
    }
    if (why == CloseReason::kRevoked) { // whether or not the client reads what it is told
        const TimePoint latest = at + limits_.revoked_deadline;
        cut_at_ = cut_at_ ? std::min(*cut_at_, latest) : latest;
    }
}

void Session::on_tick(TimePoint now) {
    adapt(now);
    if (!configuration_ && now >= configure_by_) {
        go_away("no acceptable Configure within " + std::to_string(limits_.configure_deadline.count()) + " ms", now,
                CloseReason::kNotConfigured);
    }
    if (own_feed_.feed() != nullptr && own_feed_.feed()->has_failed()) {
        go_away("the camera of this session failed; the log of the server says why", now, CloseReason::kFailed);
    }
    const auto oldest = credits_.oldest();
    if (oldest && now - *oldest >= limits_.stall_deadline) {
        go_away("a frame was not acknowledged within " + std::to_string(limits_.stall_deadline.count()) + " ms", now,
                CloseReason::kStalled);
    }
}

std::optional<wire::WireChunk> Session::next(TimePoint now) {
    if (auto control = next_control(now)) {
        return control;
    }
    if (!sending_) {
        start_frame(now);
    }
    return sending_ ? std::optional(next_chunk(now)) : std::nullopt;
}

std::optional<wire::WireChunk> Session::next_control(TimePoint now) {
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

v1::ServerMessage Session::depart(TimePoint now) {
    v1::ServerMessage message;
    v1::GoingAway& going_away = *message.mutable_going_away();
    going_away.set_reason(departure_->reason);
    departure_.reset();
    const TimePoint latest = now + limits_.going_away_deadline;
    cut_at_ = cut_at_ ? std::min(*cut_at_, latest) : latest;
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(*cut_at_ - now);
    going_away.set_deadline_ms(static_cast<std::uint32_t>(std::max(left.count(), std::int64_t{0})));
    steering_.leave();
    close_feeds();
    if (mailbox_.take()) {
        counts_.drops.add(DropReason::kLeaving);
    }
    return message;
}

v1::ServerMessage Session::heartbeat() const {
    v1::ServerMessage message;
    v1::Heartbeat& heartbeat = *message.mutable_heartbeat();
    if (configuration_) {
        const feed::LatestFrame latest = configuration_->feed->latest();
        heartbeat.set_latest_frame_id(latest.frame_id);
        heartbeat.set_scene_time_ns(latest.scene_time_ns);
    }
    return message;
}

void Session::start_frame(TimePoint now) {
    begin_frame(now);
    tell_room(now);
}

void Session::begin_frame(TimePoint now) {
    lacks_budget_ = false;
    if (mailbox_.peek() == nullptr || !credits_.allow(0)) {
        return;
    }
    const feed::EncodedFrame& newest = **mailbox_.peek();
    if (!has_key_frame_of(newest) && !feed::stands_alone(newest, configuration_->selection)) {
        set_key_frame(0);
        mailbox_.take();
        counts_.drops.add(DropReason::kNoKeyFrame);
        return;
    }
    wire::WireFrame frame = chunks_of(newest);
    if (!credits_.allow(frame.payload_bytes)) {
        return; // stays in the mailbox, where a newer one may replace it
    }
    lacks_budget_ = !bytes_.resize(credits_.bytes_in_flight() + frame.payload_bytes);
    if (lacks_budget_) {
        return; // likewise
    }
    const feed::FramePtr encoded = *mailbox_.take();
    rhythm_.begun(now);
    credits_.spend({.epoch = epoch_, .frame_id = frame.frame_id}, frame.payload_bytes, now);
    adapter_.begun({.epoch = epoch_, .frame_id = frame.frame_id}, frame.payload_bytes, now);
    timings_.begun({.epoch = epoch_, .frame_id = frame.frame_id}, configuration_->feed->info().name, *encoded,
                   frame.payload_bytes);
    auto plane_bytes = plane_bytes_of(*encoded, frame);
    sending_ = Sending{
        .frame = std::move(frame), .next_chunk = 0, .times = encoded->times, .plane_bytes = std::move(plane_bytes)};
}

std::map<wire::PlaneChoice, std::uint64_t> Session::plane_bytes_of(const feed::EncodedFrame& frame,
                                                                   const wire::WireFrame& chunks) const {
    std::map<wire::PlaneChoice, std::uint64_t> bytes;
    if (const auto* planes = std::get_if<feed::PlaneSelection>(&configuration_->selection)) {
        const bool has_key_frame = has_key_frame_of(frame);
        for (const wire::PlaneChoice& choice : planes->choices) {
            for (const wire::EncodedStrip& strip : frame.source->find(choice)->strips) {
                bytes[choice] += (has_key_frame ? strip.best : strip.alone).bytes->size(); // as in `source_chunks`
            }
        }
        return bytes;
    }
    const auto& views = std::get<feed::ViewSelection>(configuration_->selection);
    bytes[{.semantic = PlaneSemantic::kColour, .encoding = views.format.encoding}] = chunks.payload_bytes;
    return bytes;
}

wire::WireFrame Session::chunks_of(const feed::EncodedFrame& frame) const {
    const wire::ChunkOptions options{
        .epoch = epoch_, .chunk_bytes = configuration_->chunk_bytes, .has_key_frame = has_key_frame_of(frame)};
    if (const auto* planes = std::get_if<feed::PlaneSelection>(&configuration_->selection)) {
        return wire::source_chunks(*frame.source, planes->choices, options);
    }
    const auto& views = std::get<feed::ViewSelection>(configuration_->selection);
    return wire::view_chunks(*feed::find_views(frame, views.format), views.grid, options);
}

bool Session::has_key_frame_of(const feed::EncodedFrame& frame) const {
    const bool has_it = frame.key_frame_id == key_frame_id_ || frame.key_frame_id == frame.header.frame_id;
    return configuration_->keeps_key_frames && frame.key_frame_id != 0 && has_it;
}

void Session::set_key_frame(std::uint64_t frame_id) {
    key_frame_id_ = frame_id;
    if (subscription_.feed() != nullptr) {
        subscription_.set_key_need(!configuration_->keeps_key_frames ? feed::KeyNeed::kAlone
                                   : frame_id == 0                   ? feed::KeyNeed::kKey
                                                                     : feed::KeyNeed::kNone);
    }
}

wire::WireChunk Session::next_chunk(TimePoint now) {
    Sending& sending = *sending_;
    const std::size_t count = sending.frame.chunks.size();
    if (sending.next_chunk == 0) {
        sending.times.send_begin_ns = nanoseconds_of(now);
    }
    if (sending.next_chunk < count) {
        sending.times.send_end_ns = nanoseconds_of(now);
        wire::WireChunk chunk = std::move(sending.frame.chunks[sending.next_chunk++]);
        counts_.bytes_sent += chunk.size();
        return chunk;
    }
    wire::WireChunk trailer = wire::trailer_chunk(sending.frame, sending.times);
    counts_.bytes_sent += trailer.size();
    ++counts_.frames_sent;
    for (const auto& [choice, bytes] : sending.plane_bytes) {
        counts_.plane_bytes[choice] += bytes;
    }
    credits_.sent({.epoch = epoch_, .frame_id = sending.frame.frame_id}, now);
    timings_.sent({.epoch = epoch_, .frame_id = sending.frame.frame_id}, sending.times);
    if (sending.frame.key_frame_id == sending.frame.frame_id) {
        set_key_frame(sending.frame.frame_id); // what follows on the stream arrives after it
    }
    sending_.reset();
    return trailer;
}

} // namespace fieldcast::session
