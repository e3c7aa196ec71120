// SPDX-License-Identifier: Apache-2.0
#include "server/session/frames_in_flight.h"

namespace fieldcast::session {

namespace {

using std::chrono::nanoseconds;

/// Time that the client spent on decoding after the last byte, by its own clock; 0 if it does not say.
nanoseconds decode_time(const v1::FrameAck& ack) {
    const bool is_known = ack.last_byte_ns() > 0 && ack.decoded_ns() > ack.last_byte_ns();
    return nanoseconds(is_known ? ack.decoded_ns() - ack.last_byte_ns() : 0);
}

} // namespace

void FramesInFlight::begun(FrameKey key, const std::string& channel, const feed::EncodedFrame& frame,
                           std::uint64_t payload_bytes, TimePoint now) {
    credits_.spend(key, payload_bytes, now);
    adapter_.begun(key, payload_bytes, now);
    timings_.begun(key, channel, frame, payload_bytes);
}

void FramesInFlight::sent(FrameKey key, const wire::ServerTimes& times, TimePoint now) {
    credits_.sent(key, now);
    timings_.sent(key, times);
}

void FramesInFlight::aborted(FrameKey key) {
    credits_.give_back(key);
    adapter_.aborted(key);
    timings_.aborted(key);
    bytes_.resize(credits_.bytes_in_flight());
}

bool FramesInFlight::acknowledged(const v1::FrameAck& ack, TimePoint now) {
    const nanoseconds decoding = decode_time(ack);
    const bool is_first = credits_.acknowledged({.epoch = ack.epoch(), .frame_id = ack.frame_id()}, decoding, now);
    bytes_.resize(credits_.bytes_in_flight());
    timings_.acknowledged(ack);
    adapter_.acknowledged(ack, decoding, now);
    return is_first;
}

void FramesInFlight::end() {
    timings_.end();
    bytes_.resize(0);
}

} // namespace fieldcast::session
