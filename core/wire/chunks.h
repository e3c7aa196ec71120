// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/wire/encode.h"
#include "core/wire/frame_limits.h"
#include "core/wire/server_times.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

// A client's frame: each chunk is a small message head of its own, followed by payload bytes that all clients share.
//
//     WireFrame frame = source_chunks(*encoded, choices, {.epoch = 3});
//     for (const WireChunk& chunk : frame.chunks) { write(chunk); }      // may abort between chunks: FrameAborted
//     write(trailer_chunk(frame, times));                                // times are known only now
//
// With gRPC, a chunk is a grpc::ByteBuffer of two slices: `head`, copied (below 1 KiB except in the header chunk), and
// grpc::Slice(payload.data(), payload.size(), release, new SharedBytes(chunk.owner)), not copied.
namespace fieldcast::wire {

/// One gRPC message: head + payload is a serialised fieldcast.v1.ServerMessage.
struct WireChunk {
    std::string head;                   ///< everything before the payload bytes
    SharedBytes owner;                  ///< keeps `payload` alive; null if the payload is empty
    std::span<const std::byte> payload; ///< the end of the message

    std::size_t size() const { return head.size() + payload.size(); }
};

/// head + payload in one string, for recordings and tests.
std::string joined(const WireChunk& chunk);

/// How a client's frame is cut into chunks.
struct ChunkOptions {
    std::uint32_t epoch = 1;
    std::uint32_t chunk_bytes = kDefaultChunkBytes; ///< largest payload
    bool has_key_frame = true; ///< the client has the key frame; false: it gets strips that stand alone
};

/// All chunks of a frame but the trailer.
struct WireFrame {
    std::uint64_t frame_id = 0;
    std::uint32_t epoch = 0;
    std::uint64_t key_frame_id = 0;      ///< of the frame it refers to; may be its own; 0: none
    std::vector<WireChunk> chunks;       ///< header, then strips
    std::vector<DiscardCounts> discards; ///< one per view; empty for source frames
    std::uint64_t payload_bytes = 0;
    std::uint32_t crc32c = 0; ///< over all payloads
};

/// A source frame with the planes of `choices`, in that order. Each choice must have been encoded; without
/// `options.has_key_frame`, its strips must have forms that stand alone.
WireFrame source_chunks(const EncodedSource& source, std::span<const PlaneChoice> choices, const ChunkOptions& options);

/// A frame with the views of `grid`, row-major. The geometry of `grid` must be that of `views`, and every position must
/// have been encoded; without `options.has_key_frame`, its strips must have forms that stand alone.
WireFrame view_chunks(const EncodedViews& views, const ViewGrid& grid, const ChunkOptions& options);

/// The last chunk of `frame`: times, discards and CRC, without payload.
WireChunk trailer_chunk(const WireFrame& frame, const ServerTimes& times);

} // namespace fieldcast::wire
