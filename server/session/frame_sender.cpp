// SPDX-License-Identifier: Apache-2.0
#include "server/session/frame_sender.h"

namespace fieldcast::session {

void FrameSender::on_frame(const feed::FramePtr& frame, TimePoint now) {
    const auto& configuration = agreement_.configuration();
    if (!configuration) {
        return;
    }
    const TimePoint begun = frame->begun.value_or(now);
    const bool had_room = !is_full_ && begun >= has_room_since_;
    const bool is_covered = feed::covers(*frame, configuration->selection);
    if (!is_covered && !had_room) {
        return miss_frame(*frame, is_full_ ? waiting_reason() : full_because_);
    }
    if (!agreement_.pace().is_due(begun)) {
        return miss_frame(*frame, DropReason::kRateCap);
    }
    if (!is_covered) {
        if (agreement_.epoch() > 1) { // in the first epoch: begun before the client came, so not one of its frames
            counts_.drops.add(DropReason::kReconfigured);
        }
        return;
    }
    agreement_.pace().take(begun);
    if (const auto older = mailbox_.put(frame)) {
        miss_frame(**older, waiting_reason());
    }
    if (sending_ || !in_flight_.credits().allow(0)) {
        update_room(now);
    }
}

void FrameSender::acknowledged(const v1::FrameAck& ack, TimePoint now) {
    const bool is_first = in_flight_.acknowledged(ack, now);
    if (is_first && ack.outcome() == v1::FRAME_OUTCOME_FAILED) {
        ++counts_.frames_failed;
        if (ack.epoch() == agreement_.epoch()) {
            set_key_frame(0); // it was the key frame, or it referred to one that the client does not have
        }
    }
}

std::optional<v1::FrameAborted> FrameSender::begin_epoch() {
    std::optional<v1::FrameAborted> aborted;
    if (sending_) {
        aborted.emplace();
        aborted->set_frame_id(sending_->key.frame_id);
        aborted->set_epoch(sending_->key.epoch);
        aborted->set_reason(v1::ABORT_REASON_RECONFIGURED);
        in_flight_.aborted(sending_->key);
        counts_.drops.add(DropReason::kReconfigured);
        sending_.reset();
    }
    drop_waiting(DropReason::kReconfigured);
    in_flight_.configure(*agreement_.configuration());
    is_full_ = false; // the mailbox is empty
    has_room_since_ = {};
    agreement_.subscription().set_room({});
    set_key_frame(0);
    return aborted;
}

void FrameSender::drop_waiting(DropReason reason) {
    if (mailbox_.take()) {
        counts_.drops.add(reason);
    }
}

std::optional<wire::WireChunk> FrameSender::next(TimePoint now) {
    if (!sending_) {
        begin_frame(now);
        update_room(now);
    }
    return sending_ ? std::optional(next_chunk(now)) : std::nullopt;
}

DropReason FrameSender::waiting_reason() const {
    return sending_ ? DropReason::kSending : lacks_budget_ ? DropReason::kNoBudget : DropReason::kNoCredit;
}

void FrameSender::miss_frame(const feed::EncodedFrame& frame, DropReason reason) {
    counts_.drops.add(reason);
    if (reason != DropReason::kRateCap) {
        in_flight_.adapter().missed();
    }
    if (frame.key_frame_id != 0 && frame.key_frame_id == frame.header.frame_id) {
        set_key_frame(0); // later frames refer to the missed one
    }
}

void FrameSender::update_room(TimePoint now) {
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
    feed::Subscription& subscription = agreement_.subscription();
    if (subscription.feed() != nullptr) {
        subscription.set_room({.taken_until = is_full ? std::optional(rhythm_.next(now)) : std::nullopt});
    }
}

void FrameSender::begin_frame(TimePoint now) {
    lacks_budget_ = false;
    if (mailbox_.peek() == nullptr || !in_flight_.credits().allow(0)) {
        return;
    }
    const feed::EncodedFrame& newest = **mailbox_.peek();
    if (!has_key_frame_of(newest) && !feed::stands_alone(newest, agreement_.configuration()->selection)) {
        set_key_frame(0);
        drop_waiting(DropReason::kNoKeyFrame);
        return;
    }
    wire::WireFrame frame = chunks_of(newest);
    if (!in_flight_.credits().allow(frame.payload_bytes)) {
        return; // stays in the mailbox, where a newer one may replace it
    }
    lacks_budget_ = !in_flight_.reserve(frame.payload_bytes);
    if (lacks_budget_) {
        return; // likewise
    }
    const feed::FramePtr encoded = *mailbox_.take();
    const FrameKey key{.epoch = agreement_.epoch(), .frame_id = frame.frame_id};
    rhythm_.begun(now);
    in_flight_.begun(key, agreement_.configuration()->feed->info().name, *encoded, frame.payload_bytes, now);
    auto plane_bytes = plane_bytes_of(*encoded, frame);
    sending_ = Sending{.key = key,
                       .frame = std::move(frame),
                       .next_chunk = 0,
                       .times = encoded->times,
                       .plane_bytes = std::move(plane_bytes)};
}

std::map<wire::PlaneChoice, std::uint64_t> FrameSender::plane_bytes_of(const feed::EncodedFrame& frame,
                                                                       const wire::WireFrame& chunks) const {
    std::map<wire::PlaneChoice, std::uint64_t> bytes;
    const feed::Selection& selection = agreement_.configuration()->selection;
    if (const auto* planes = std::get_if<feed::PlaneSelection>(&selection)) {
        const bool has_key_frame = has_key_frame_of(frame);
        for (const wire::PlaneChoice& choice : planes->choices) {
            for (const wire::EncodedStrip& strip : frame.source->find(choice)->strips) {
                bytes[choice] += (has_key_frame ? strip.best : strip.alone).bytes->size(); // as in `source_chunks`
            }
        }
        return bytes;
    }
    const auto& views = std::get<feed::ViewSelection>(selection);
    bytes[{.semantic = PlaneSemantic::kColour, .encoding = views.format.encoding}] = chunks.payload_bytes;
    return bytes;
}

wire::WireFrame FrameSender::chunks_of(const feed::EncodedFrame& frame) const {
    const Configuration& configuration = *agreement_.configuration();
    const wire::ChunkOptions options{.epoch = agreement_.epoch(),
                                     .chunk_bytes = configuration.chunk_bytes,
                                     .has_key_frame = has_key_frame_of(frame)};
    if (const auto* planes = std::get_if<feed::PlaneSelection>(&configuration.selection)) {
        return wire::source_chunks(*frame.source, planes->choices, options);
    }
    const auto& views = std::get<feed::ViewSelection>(configuration.selection);
    return wire::view_chunks(*feed::find_views(frame, views.format), views.grid, options);
}

bool FrameSender::has_key_frame_of(const feed::EncodedFrame& frame) const {
    const bool has_it = frame.key_frame_id == key_frame_id_ || frame.key_frame_id == frame.header.frame_id;
    return agreement_.configuration()->keeps_key_frames && frame.key_frame_id != 0 && has_it;
}

void FrameSender::set_key_frame(std::uint64_t frame_id) {
    key_frame_id_ = frame_id;
    feed::Subscription& subscription = agreement_.subscription();
    if (subscription.feed() != nullptr) {
        subscription.set_key_need(!agreement_.configuration()->keeps_key_frames ? feed::KeyNeed::kAlone
                                  : frame_id == 0                               ? feed::KeyNeed::kKey
                                                                                : feed::KeyNeed::kNone);
    }
}

wire::WireChunk FrameSender::next_chunk(TimePoint now) {
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
    in_flight_.sent(sending.key, sending.times, now);
    if (sending.frame.key_frame_id == sending.frame.frame_id) {
        set_key_frame(sending.frame.frame_id); // the client has it before everything that follows on the stream
    }
    sending_.reset();
    return trailer;
}

} // namespace fieldcast::session
