// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace fieldcast::wire {

// Payload bytes of one chunk.
inline constexpr std::uint32_t kDefaultChunkBytes = 256U << 10;
inline constexpr std::uint32_t kMinChunkBytes = 16U << 10;
inline constexpr std::uint32_t kMaxChunkBytes = 2U << 20;

/// Upper bounds for one frame. Anything beyond them is a DecodeError before memory is allocated. Clients derive them
/// from Configured.
struct FrameLimits {
    std::uint32_t max_width_px = 4096;              ///< of a plane (with guard band) or a view
    std::uint32_t max_height_px = 4096;             ///< of a plane (with guard band) or a view
    std::uint64_t max_frame_bytes = 512ULL << 20;   ///< decoded bytes of all planes or views of a frame
    std::uint32_t max_chunk_bytes = kMaxChunkBytes; ///< payload of one chunk
};

} // namespace fieldcast::wire
