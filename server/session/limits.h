// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace fieldcast::session {

/// Limits on resources and times of clients; further limits depend on the channel. By default one peer may have a
/// quarter of a total, and the last eighth of it is kept for peers that have none (newcomers_reserve).
struct Limits {
    std::uint32_t max_connections = 256; ///< fewer if the process may open few descriptors
    std::uint32_t max_sessions = 64;
    std::uint32_t max_sessions_per_peer = 16;
    double max_opens_per_second_per_peer = 10.0; ///< sessions, on average; up to max_sessions_per_peer at once
    std::uint64_t max_view_set_pixels = 72ULL * 1280 * 720;     ///< rows · columns · width · height of one session
    std::uint64_t max_pixels_per_peer = 36ULL * 1280 * 720;     ///< the same, over all sessions of one peer
    std::uint32_t max_own_cameras = 4;                          ///< of single clients, over all channels
    std::uint32_t max_own_cameras_per_peer = 1;                 ///< over all sessions of one peer
    std::uint64_t max_bytes_in_flight = 256ULL << 20;           ///< of one session
    std::uint64_t max_bytes_in_flight_per_peer = 1024ULL << 20; ///< over all sessions of one peer
    std::uint64_t max_bytes_in_flight_in_total = 4096ULL << 20; ///< over all sessions
    std::uint32_t max_scene_downloads = 16;
    std::uint32_t max_scene_downloads_per_peer = 4;
    double max_messages_per_second = 1000.0; ///< of one session, on average; up to twice as many at once
    double max_poses_per_second = 240.0;     ///< of one session, on average; up to as many at once
    std::uint32_t max_chunk_bytes = 2U << 20;
    std::chrono::milliseconds configure_deadline{10'000}; ///< from opening to the first Configured
    std::chrono::milliseconds stall_deadline{30'000};     ///< for an acknowledgement, and for writing a message
    std::chrono::milliseconds going_away_deadline{5'000}; ///< from GoingAway to cutting the stream
    std::chrono::milliseconds revoked_deadline{3'000};    ///< from the removal of the token to cutting the stream
    std::chrono::milliseconds channel_deadline{120'000};  ///< a subscriber waits longer: the channel is unhealthy
    std::chrono::milliseconds handshake_deadline{10'000}; ///< from accepting a connection to its first HTTP/2 settings
    std::chrono::milliseconds idle_deadline{300'000};     ///< a connection without calls is closed
    std::chrono::milliseconds keepalive_interval{20'000}; ///< silence after which a connection is pinged
    std::chrono::milliseconds keepalive_timeout{10'000};  ///< for the answer to a ping
    std::chrono::milliseconds heartbeat_interval{250};    ///< the protocol asks for at most 500 ms
    std::chrono::milliseconds probe_interval{1'000};      ///< from an answer of the own port to the next probe
    std::chrono::milliseconds probe_patience{5'000};      ///< for the answer; a busy machine may take seconds
    int probe_failures_until_deaf = 3;                    ///< consecutive failures; then the port counts as deaf
};

/// Messages that one Configure counts as, because it changes the rendering.
inline constexpr double kConfigureWeight = 50.0;

/// Every this many whole bytes of a message count as one message more.
inline constexpr std::size_t kBytesPerMessage = 128;

/// Largest message of a client, bytes: more than twice a Configure in which every field has its largest size.
inline constexpr int kMaxClientMessageBytes = 8 << 10;

/// Most answers waiting to be sent; at this number the server stops reading from the client.
inline constexpr std::size_t kMaxQueuedAnswers = 16;

} // namespace fieldcast::session
