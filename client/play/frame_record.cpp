// SPDX-License-Identifier: Apache-2.0
#include "client/play/frame_record.h"

#include "core/base/printable.h"

namespace fieldcast::client::play {

timing::DeliveredFrame frame_record(const net::FrameArrived& arrived, const std::string& channel,
                                    std::uint32_t session_number) {
    const wire::ServerTimes& server = arrived.frame.server_times;
    const auto ours = [&](std::int64_t server_ns) {
        return arrived.clock ? timing::on_our_clock(server_ns, -arrived.clock->server_minus_client_ns) : 0;
    };
    timing::DeliveredFrame record;
    record.made = {.channel = printable(channel),
                   .frame_id = arrived.frame_id,
                   .scene_time_ns = arrived.frame.header().scene_time_ns,
                   .pose_sampled_ns = ours(server.pose_sampled_ns),
                   .render_begin_ns = ours(server.render_begin_ns),
                   .render_end_ns = ours(server.render_end_ns),
                   .encode_begin_ns = ours(server.encode_begin_ns),
                   .encode_end_ns = ours(server.encode_end_ns),
                   .stages = arrived.frame.header().render_times};
    record.client = session_number;
    record.epoch = arrived.frame.epoch;
    record.outcome = timing::Outcome::kDecoded;
    record.payload_bytes = arrived.frame.payload_bytes;
    record.send_begin_ns = ours(server.send_begin_ns);
    record.send_end_ns = ours(server.send_end_ns);
    record.first_byte_ns = arrived.first_byte_ns;
    record.last_byte_ns = arrived.last_byte_ns;
    record.decoded_ns = arrived.decoded_ns;
    record.clock_round_trip_ns = arrived.clock ? arrived.clock->round_trip_ns : 0;
    return record;
}

void add_record(timing::TimingRecorder& recorder, timing::DeliveredFrame record) {
    recorder.add(record.made);
    recorder.add(std::move(record));
}

} // namespace fieldcast::client::play
