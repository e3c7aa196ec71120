// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace fieldcast::session {

/// What one client may ask for and how long it may take; the rest depends on the channel. One peer may have a quarter
/// of what there is, and the last eighth is kept for peers that have nothing (newcomers_reserve).
struct Limits {
    std::uint32_t max_connections = 256; ///< fewer if there are few descriptors
    std::uint32_t max_sessions = 64;
    std::uint32_t max_sessions_per_peer = 16;
    double max_opens_per_second_per_peer = 10.0; ///< sessions, on average; max_sessions_per_peer of them at once
    std::uint64_t max_view_set_pixels = 72ULL * 1280 * 720;     ///< rows · columns · width · height of one session
    std::uint64_t max_pixels_per_peer = 36ULL * 1280 * 720;     ///< the same, over the sessions of one peer
    std::uint32_t max_own_cameras = 4;                          ///< of clients that have one each, over all channels
    std::uint32_t max_own_cameras_per_peer = 1;                 ///< over the sessions of one peer
    std::uint64_t max_bytes_in_flight = 256ULL << 20;           ///< of one session
    std::uint64_t max_bytes_in_flight_per_peer = 1024ULL << 20; ///< over the sessions of one peer
    std::uint64_t max_bytes_in_flight_in_total = 4096ULL << 20; ///< over all sessions
    std::uint32_t max_scene_downloads = 16;
    std::uint32_t max_scene_downloads_per_peer = 4;
    double max_messages_per_second = 1000.0; ///< of one session, on average; twice as many at once
    double max_poses_per_second = 240.0;     ///< of one session, on average; as many at once
    std::uint32_t max_chunk_bytes = 2U << 20;
    std::chrono::milliseconds configure_deadline{10'000}; ///< from opening to the first Configured
    std::chrono::milliseconds stall_deadline{30'000};     ///< a frame unacknowledged, or a message unsent
    std::chrono::milliseconds going_away_deadline{5'000}; ///< from GoingAway to the forced end
    std::chrono::milliseconds revoked_deadline{3'000};    ///< the same once its token has gone, and from then on
    std::chrono::milliseconds channel_deadline{120'000};  ///< no frame although somebody waits: not healthy
    std::chrono::milliseconds handshake_deadline{10'000}; ///< from the connection to its first HTTP/2 settings
    std::chrono::milliseconds idle_deadline{300'000};     ///< a connection without calls
    std::chrono::milliseconds keepalive_interval{20'000}; ///< silence after which a connection is asked
    std::chrono::milliseconds keepalive_timeout{10'000};  ///< for its answer
    std::chrono::milliseconds heartbeat_interval{250};    ///< the protocol asks for at most 500 ms
    std::chrono::milliseconds probe_interval{1'000};      ///< from an answer of the own port to the next question
    std::chrono::milliseconds probe_patience{5'000};      ///< for that answer; a busy machine may take seconds
    int probe_failures_until_deaf = 3;                    ///< in a row
};

/// A Configure counts as so many messages: it changes what is rendered.
inline constexpr double kConfigureWeight = 50.0;

/// So many whole bytes of a message count as one message more.
inline constexpr std::size_t kBytesPerMessage = 128;

/// Largest message of a client, bytes: more than twice a Configure in which every field is as large as it may be.
inline constexpr int kMaxClientMessageBytes = 8 << 10;

/// Answers waiting to be sent; beyond, the client is not read from.
inline constexpr std::size_t kMaxQueuedAnswers = 16;

} // namespace fieldcast::session
