// SPDX-License-Identifier: Apache-2.0
#include "server/session/negotiate.h"

namespace fieldcast::session {

namespace {

void add_planes(v1::Configured& message, const feed::PlanesWish& wish, const feed::ChannelInfo& channel) {
    const GuardBand& band = channel.guard_band;
    for (const wire::PlaneChoice& choice : wish.choices) {
        v1::PlaneHeader& plane = *message.add_planes();
        plane.set_semantic(wire::to_proto(choice.semantic));
        plane.set_format(wire::to_proto(wire::wire_format(choice.semantic)));
        plane.set_codec(wire::to_proto(choice.encoding.codec));
        plane.set_width_px(channel.source_width_px + band.left_px + band.right_px);
        plane.set_height_px((channel.source_height_px + band.top_px + band.bottom_px) * channel.source_count);
    }
}

void add_planes(v1::Configured& message, const feed::ViewsWish& wish, const feed::ChannelInfo&) {
    v1::PlaneHeader& plane = *message.add_planes();
    plane.set_semantic(v1::PLANE_SEMANTIC_COLOUR);
    plane.set_format(v1::PLANE_FORMAT_RGB8);
    plane.set_codec(wire::to_proto(wish.format.encoding.codec));
    plane.set_width_px(wish.format.width_px);
    plane.set_height_px(wish.format.height_px);
}

} // namespace

v1::Configured to_message(const Configuration& configuration, std::uint32_t request_id, std::uint32_t epoch,
                          std::uint32_t credits) {
    const feed::ChannelInfo& channel = configuration.feed->info();
    v1::Configured message;
    message.set_request_id(request_id);
    message.set_epoch(epoch);
    message.set_channel(channel.name);
    message.set_scene_hash(channel.scene_hash.data(), channel.scene_hash.size());
    message.set_mode(configuration.mode);
    wire::to_proto(configuration.view_set, *message.mutable_view_set());
    std::visit([&](const auto& wish) { add_planes(message, wish, channel); }, configuration.wish);
    wire::to_proto(channel.guard_band, *message.mutable_guard_band());
    message.set_frames_per_second(configuration.frames_per_second);
    message.set_max_bytes_in_flight(configuration.max_bytes_in_flight);
    message.set_max_frames_in_flight(credits);
    message.set_chunk_bytes(configuration.chunk_bytes);
    return message;
}

v1::Refused to_message(const Refusal& refusal, std::uint32_t request_id) {
    v1::Refused message;
    message.set_request_id(request_id);
    message.set_reason(refusal.reason);
    message.set_field(refusal.field);
    message.set_message(refusal.message);
    return message;
}

} // namespace fieldcast::session
