// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/wire/encode.h"

#include <string>

// A client's frame: small messages of its own in front of payload bytes that all clients share.
//
//     WireFrame frame = source_chunks(*encoded, choices, {.epoch = 3});
//     for (const WireChunk& chunk : frame.chunks) { write(chunk); }      // may abort between chunks: FrameAborted
//     write(trailer_chunk(frame, times));                                // times are known only now
//
// Writing with gRPC: grpc::ByteBuffer of two slices, `head` (copied, < 1 KiB but for the header chunk) and
// grpc::Slice(payload.data(), payload.size(), release, new SharedBytes(chunk.owner)) (not copied).
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

inline constexpr std::uint32_t kDefaultChunkBytes = 256U << 10;
inline constexpr std::uint32_t kMinChunkBytes = 16U << 10;
inline constexpr std::uint32_t kMaxChunkBytes = 2U << 20;

struct ChunkOptions {
    std::uint32_t epoch = 1;
    std::uint32_t chunk_bytes = kDefaultChunkBytes; ///< largest payload
    bool has_key_frame = true; ///< the client has what the frame refers to; false: it gets strips that stand alone
};

/// Server's steady clock, nanoseconds; 0: unknown.
struct ServerTimes {
    std::int64_t pose_sampled_ns = 0;
    std::int64_t render_begin_ns = 0;
    std::int64_t render_end_ns = 0;
    std::int64_t encode_begin_ns = 0;
    std::int64_t encode_end_ns = 0;
    std::int64_t send_begin_ns = 0; ///< header chunk handed to the transport
    std::int64_t send_end_ns = 0;   ///< last strip chunk handed to the transport

    bool operator==(const ServerTimes&) const = default;
};

/// All chunks of a frame but the trailer.
struct WireFrame {
    std::uint64_t frame_id = 0;
    std::uint32_t epoch = 0;
    std::uint64_t key_frame_id = 0; ///< that it refers to; may be its own; 0: none
    std::vector<WireChunk> chunks;  ///< header, then strips
    std::vector<DiscardCounts> discards;
    std::uint64_t payload_bytes = 0;
    std::uint32_t crc32c = 0; ///< over all payloads
};

/// A source frame with the chosen planes, in that order. Each choice must have been encoded, to stand alone if the
/// client lacks the key frame.
WireFrame source_chunks(const EncodedSource& source, std::span<const PlaneChoice> choices, const ChunkOptions& options);

/// The views of `grid`, row-major. Its geometry must be that of `views`, and every position must have been encoded, to
/// stand alone if the client lacks the key frame.
WireFrame view_chunks(const EncodedViews& views, const ViewGrid& grid, const ChunkOptions& options);

WireChunk trailer_chunk(const WireFrame& frame, const ServerTimes& times);

} // namespace fieldcast::wire
