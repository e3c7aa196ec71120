// SPDX-License-Identifier: Apache-2.0
#include "server/session/configuration.h"

#include <algorithm>

namespace fieldcast::session {

namespace {

/// Largest width and height of a plane in frames of `channel`, px, including the layers of illumination.
glm::uvec2 largest_plane(PlaneSemantic semantic, const feed::ChannelInfo& channel) {
    if (is_residual(semantic)) {
        const glm::uvec2 tiles = residual_tiles(channel.source_width_px, channel.source_height_px);
        const std::size_t count = std::size_t{tiles.x} * tiles.y * kMaxResidualViews;
        return {kResidualColumns * kResidualTile, residual_height(std::min(count, max_residual_tiles()))};
    }
    const GuardBand& band = channel.guard_band;
    const std::uint32_t pages = channel.source_count * (is_illumination(semantic) ? 1 + kMaxLayers : 1);
    const std::uint32_t height_px = channel.source_height_px + band.top_px + band.bottom_px;
    return {channel.source_width_px + band.left_px + band.right_px, std::min(height_px * pages, kMaxPlaneSide)};
}

void add_plane(v1::Configured& message, PlaneSemantic semantic, PlaneFormat format, const codec::Encoding& encoding,
               glm::uvec2 size_px) {
    v1::PlaneHeader& plane = *message.add_planes();
    plane.set_semantic(wire::to_proto(semantic));
    plane.set_format(wire::to_proto(format));
    plane.set_codec(wire::to_proto(encoding.codec));
    plane.set_quality(encoding.quality);
    plane.set_width_px(size_px.x);
    plane.set_height_px(size_px.y);
}

void add_planes(v1::Configured& message, const feed::PlaneSelection& selection, const feed::ChannelInfo& channel) {
    for (const wire::PlaneChoice& choice : selection.choices) {
        add_plane(message, choice.semantic, wire::format_of(choice), choice.encoding,
                  largest_plane(choice.semantic, channel));
    }
}

void add_planes(v1::Configured& message, const feed::ViewSelection& selection, const feed::ChannelInfo&) {
    const wire::ViewFormat& format = selection.format;
    add_plane(message, PlaneSemantic::kColour, usual_format(PlaneSemantic::kColour), format.encoding,
              {format.width_px, format.height_px});
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
    message.set_mode(wire::to_proto(configuration.mode));
    wire::to_proto(configuration.view_set, *message.mutable_view_set());
    std::visit([&](const auto& selection) { add_planes(message, selection, channel); }, configuration.selection);
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
