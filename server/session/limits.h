// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace fieldcast::session {

/// What one client may ask for and how long it may take; the rest depends on the channel.
struct Limits {
    std::uint32_t max_sessions = 64;
    std::uint32_t max_sessions_per_peer = 64;
    std::uint64_t max_view_set_pixels = 72ULL * 1280 * 720; ///< rows · columns · width · height
    std::uint64_t max_bytes_in_flight = 256ULL << 20;
    std::uint32_t max_chunk_bytes = 2U << 20;
    std::chrono::milliseconds configure_deadline{10'000}; ///< from opening to the first Configured
    std::chrono::milliseconds stall_deadline{30'000};     ///< a frame unacknowledged, or a message unsent
    std::chrono::milliseconds going_away_deadline{5'000}; ///< from GoingAway to the forced end
    std::chrono::milliseconds channel_deadline{120'000};  ///< no frame although somebody waits: not healthy
    std::chrono::milliseconds heartbeat_interval{250};    ///< the protocol asks for at most 500 ms
};

/// Largest message of a client, bytes. A Configure is below 1 KiB.
inline constexpr int kMaxClientMessageBytes = 64 << 10;

/// Answers waiting to be sent; beyond, the client is not read from.
inline constexpr std::size_t kMaxQueuedAnswers = 16;

} // namespace fieldcast::session
