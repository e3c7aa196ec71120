// SPDX-License-Identifier: Apache-2.0
#include "server/session/frame_timings.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace fieldcast::session {

namespace {

using timing::DeliveredFrame;
using timing::Outcome;

Outcome outcome_of(const v1::FrameAck& ack) {
    switch (ack.outcome()) {
    case v1::FRAME_OUTCOME_FAILED:
        return Outcome::kFailed;
    case v1::FRAME_OUTCOME_SUPERSEDED:
        return Outcome::kSuperseded;
    default:
        return ack.shown_ns() > 0 ? Outcome::kShown : Outcome::kDecoded;
    }
}

/// Adds the client's times, on the server's clock; they stay unknown if the clock offset is.
void add_times(const v1::FrameAck& ack, DeliveredFrame& record) {
    if (!ack.has_clock()) {
        return;
    }
    const auto ours = [&](std::int64_t time_ns) {
        return timing::on_our_clock(time_ns, ack.clock().server_minus_client_ns());
    };
    record.first_byte_ns = ours(ack.first_byte_ns());
    record.last_byte_ns = ours(ack.last_byte_ns());
    record.decoded_ns = ours(ack.decoded_ns());
    record.rendered_ns = ours(ack.rendered_ns());
    record.shown_ns = ours(ack.shown_ns());
    record.clock_round_trip_ns = std::max<std::int64_t>(ack.clock().round_trip_ns(), 0);
}

} // namespace

timing::MadeFrame made_frame(const std::string& channel, const feed::EncodedFrame& frame) {
    timing::MadeFrame made{.channel = channel,
                           .frame_id = frame.header.frame_id,
                           .scene_time_ns = frame.header.scene_time_ns,
                           .pose_sampled_ns = frame.times.pose_sampled_ns,
                           .render_begin_ns = frame.times.render_begin_ns,
                           .render_end_ns = frame.times.render_end_ns,
                           .encode_begin_ns = frame.times.encode_begin_ns,
                           .encode_end_ns = frame.times.encode_end_ns,
                           .stages = frame.header.render_times};
    for (const wire::EncodedViews& views : frame.views) { // times of views repeat those of the source first
        const auto& times = views.header.render_times;
        const bool is_first_of_batch = std::ranges::none_of(frame.views, [&](const wire::EncodedViews& other) {
            return &other < &views && other.header.render_times == times;
        });
        if (is_first_of_batch && times.size() > frame.header.render_times.size()) {
            made.stages.insert(made.stages.end(),
                               times.begin() + static_cast<std::ptrdiff_t>(frame.header.render_times.size()),
                               times.end());
        }
    }
    return made;
}

FrameTimings::Records::iterator FrameTimings::find(FrameKey key) {
    return std::ranges::find_if(pending_, [&](const DeliveredFrame& record) {
        return record.epoch == key.epoch && record.made.frame_id == key.frame_id;
    });
}

void FrameTimings::finish(Records::iterator record) {
    finished_.push_back(std::move(*record));
    pending_.erase(record);
    if (finished_.size() > kMaxPending) {
        finished_.pop_front();
    }
}

void FrameTimings::begun(FrameKey key, const std::string& channel, const feed::EncodedFrame& frame,
                         std::uint64_t payload_bytes) {
    if (!is_enabled_) {
        return;
    }
    DeliveredFrame record;
    record.made = made_frame(channel, frame);
    record.epoch = key.epoch;
    record.payload_bytes = payload_bytes;
    pending_.push_back(std::move(record));
    if (pending_.size() > kMaxPending) {
        finish(pending_.begin());
    }
}

void FrameTimings::sent(FrameKey key, const wire::ServerTimes& times) {
    const auto record = find(key);
    if (record != pending_.end()) {
        record->send_begin_ns = times.send_begin_ns;
        record->send_end_ns = times.send_end_ns;
    }
}

void FrameTimings::aborted(FrameKey key) {
    const auto record = find(key);
    if (record != pending_.end()) {
        record->outcome = Outcome::kAborted;
        finish(record);
    }
}

void FrameTimings::acknowledged(const v1::FrameAck& ack) {
    const auto record = find({.epoch = ack.epoch(), .frame_id = ack.frame_id()});
    if (record == pending_.end() || record->send_end_ns == 0) {
        return; // also if the client acknowledges a frame that it cannot have received
    }
    record->outcome = outcome_of(ack);
    add_times(ack, *record);
    if (record->outcome != Outcome::kDecoded) {
        finish(record);
    }
}

void FrameTimings::end() {
    while (!pending_.empty()) {
        finish(pending_.begin());
    }
}

std::vector<DeliveredFrame> FrameTimings::take_finished() {
    std::vector<DeliveredFrame> records(std::make_move_iterator(finished_.begin()),
                                        std::make_move_iterator(finished_.end()));
    finished_.clear();
    return records;
}

} // namespace fieldcast::session
