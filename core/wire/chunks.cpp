// SPDX-License-Identifier: Apache-2.0
#include "core/wire/chunks.h"

#include "core/codec/crc32c.h"
#include "core/wire/base_view.h"
#include "core/wire/convert.h"

#include "fieldcast/v1/light_field.pb.h"

#include <algorithm>

namespace fieldcast::wire {

namespace {

constexpr std::uint32_t kLengthDelimited = 2; // protobuf wire type of messages and bytes

void append_varint(std::string& out, std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) {
        out.push_back(static_cast<char>(value | 0x80));
    }
    out.push_back(static_cast<char>(value));
}

void append_field(std::string& out, int number, std::uint64_t bytes) {
    append_varint(out, static_cast<std::uint32_t>(number) << 3 | kLengthDelimited);
    append_varint(out, bytes);
}

/// The serialised ServerMessage of `chunk`, up to the position at which `payload_bytes` bytes of payload follow.
std::string make_head(const v1::FrameChunk& chunk, std::size_t payload_bytes) {
    std::string inner = chunk.SerializeAsString();
    if (payload_bytes > 0) {
        append_field(inner, v1::FrameChunk::kPayloadFieldNumber, payload_bytes);
    }
    std::string head;
    append_field(head, v1::ServerMessage::kFrameChunkFieldNumber, inner.size() + payload_bytes);
    return head + inner;
}

v1::FrameChunk next_chunk(const WireFrame& frame) {
    v1::FrameChunk chunk;
    chunk.set_frame_id(frame.frame_id);
    chunk.set_epoch(frame.epoch);
    chunk.set_index(static_cast<std::uint32_t>(frame.chunks.size()));
    return chunk;
}

void append_strip(WireFrame& frame, std::uint32_t part, const EncodedStrip& strip, const ChunkOptions& options) {
    const StripBytes& form = options.has_key_frame ? strip.best : strip.alone;
    FC_ASSERT(form.bytes != nullptr, "clients without the key frame need strips that stand alone");
    const std::span<const std::byte> bytes(*form.bytes);
    const std::uint32_t chunk_bytes = options.chunk_bytes;
    for (std::size_t offset = 0; offset < bytes.size(); offset += chunk_bytes) {
        const auto payload = bytes.subspan(offset, std::min<std::size_t>(chunk_bytes, bytes.size() - offset));
        v1::FrameChunk chunk = next_chunk(frame);
        v1::StripSlice& slice = *chunk.mutable_strip();
        slice.set_part(part);
        slice.set_first_row(strip.band.first_row);
        slice.set_row_count(strip.band.row_count);
        slice.set_strip_bytes(static_cast<std::uint32_t>(bytes.size()));
        slice.set_slice_offset(static_cast<std::uint32_t>(offset));
        frame.chunks.push_back({make_head(chunk, payload.size()), form.bytes, payload});
    }
    frame.crc32c = codec::crc32c_combine(frame.crc32c, form.crc32c, bytes.size());
    frame.payload_bytes += bytes.size();
}

void append_plane(WireFrame& frame, std::uint32_t part, const EncodedPlane& plane, const ChunkOptions& options) {
    for (const EncodedStrip& strip : plane.strips) {
        append_strip(frame, part, strip, options);
    }
}

WireFrame begin_frame(const FrameHeader& header, std::uint64_t key_frame_id, const ChunkOptions& options,
                      v1::FrameHeader& message) {
    FC_ASSERT(options.chunk_bytes > 0 && options.chunk_bytes <= kMaxChunkBytes, "chunk size");
    WireFrame frame;
    frame.frame_id = header.frame_id;
    frame.epoch = options.epoch;
    frame.key_frame_id = options.has_key_frame ? key_frame_id : 0;
    to_proto(header, message);
    message.set_key_frame_id(frame.key_frame_id);
    return frame;
}

void append_header(WireFrame& frame, v1::FrameHeader&& message) {
    v1::FrameChunk chunk = next_chunk(frame);
    *chunk.mutable_header() = std::move(message);
    frame.chunks.push_back({make_head(chunk, 0), nullptr, {}});
}

} // namespace

std::string joined(const WireChunk& chunk) {
    std::string bytes = chunk.head;
    bytes.append(reinterpret_cast<const char*>(chunk.payload.data()), chunk.payload.size());
    return bytes;
}

WireFrame source_chunks(const EncodedSource& source, std::span<const PlaneChoice> choices,
                        const ChunkOptions& options) {
    v1::FrameHeader message;
    WireFrame frame = begin_frame(source.header, source.key_frame_id, options, message);
    std::vector<const EncodedPlane*> planes;
    for (const PlaneChoice choice : choices) {
        const EncodedPlane* plane = source.find(choice);
        FC_ASSERT(plane != nullptr, "every chosen plane was encoded");
        planes.push_back(plane);
        v1::PlaneHeader& entry = *message.mutable_planes()->add_planes();
        entry.set_semantic(to_proto(plane->semantic));
        entry.set_format(to_proto(plane->format));
        entry.set_codec(to_proto(plane->encoding.codec));
        entry.set_width_px(plane->width_px);
        entry.set_height_px(plane->height_px);
    }
    if (std::ranges::none_of(choices, is_residual, &PlaneChoice::semantic)) {
        message.clear_residual(); // only planes of the residual layer need it
    }
    append_header(frame, std::move(message));
    for (std::uint32_t part = 0; part < planes.size(); ++part) {
        append_plane(frame, part, *planes[part], options);
    }
    return frame;
}

WireFrame view_chunks(const EncodedViews& views, const ViewGrid& grid, const ChunkOptions& options) {
    const ViewFormat& format = views.format;
    FC_ASSERT(grid.geometry == format.geometry, "the grid has the lattice geometry of the views");
    v1::FrameHeader message;
    WireFrame frame = begin_frame(views.header, views.key_frame_id, options, message);
    const ViewSet set{grid, format.width_px, format.height_px, format.fovy_rad};
    to_proto(set, *message.mutable_views()->mutable_view_set());
    message.mutable_views()->set_codec(to_proto(format.encoding.codec));
    append_header(frame, std::move(message));
    std::vector<const EncodedView*> parts;
    for (const LatticePosition position : lattice_positions(grid)) {
        const auto view = views.views.find(position);
        FC_ASSERT(view != views.views.end(), "every view of the grid was encoded");
        parts.push_back(&view->second);
        frame.discards.push_back(view->second.discards);
    }
    const std::uint32_t base = base_part(grid); // sent first, because others may be predicted from it
    append_plane(frame, base, parts[base]->image, options);
    for (std::uint32_t part = 0; part < parts.size(); ++part) {
        if (part != base) {
            append_plane(frame, part, parts[part]->image, options);
        }
    }
    return frame;
}

WireChunk trailer_chunk(const WireFrame& frame, const ServerTimes& times) {
    v1::FrameChunk chunk = next_chunk(frame);
    v1::FrameTrailer& trailer = *chunk.mutable_trailer();
    to_proto(times, *trailer.mutable_times());
    for (const DiscardCounts& counts : frame.discards) {
        to_proto(counts, *trailer.add_discards());
    }
    trailer.set_crc32c(frame.crc32c);
    return {make_head(chunk, 0), nullptr, {}};
}

} // namespace fieldcast::wire
