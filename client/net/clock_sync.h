// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

namespace fieldcast::client::net {

/// Nanoseconds on this process' steady clock.
std::int64_t steady_now_ns();

/// Offset between the server's and our steady clock. Of the last `kWindow` exchanges the one with the shortest round
/// trip counts: it was delayed least, so its error is the smallest (at most half its round trip).
class ClockSync {
public:
    struct Exchange {
        std::int64_t client_send_ns = 0;
        std::int64_t server_receive_ns = 0;
        std::int64_t server_send_ns = 0;
        std::int64_t client_receive_ns = 0;
    };

    /// Ignores exchanges that cannot be true (negative round trip).
    void add(const Exchange& exchange);

    /// A moment of the server's clock on ours. Empty before the first exchange, and for 0, which means "unknown".
    std::optional<std::int64_t> client_from_server_ns(std::int64_t server_ns) const;
    std::optional<std::int64_t> round_trip_ns() const; ///< the shortest of the window

    /// What the exchange with that round trip says.
    struct Offset {
        std::int64_t server_minus_client_ns = 0;
        std::int64_t round_trip_ns = 0;
    };
    std::optional<Offset> offset() const;

    static constexpr std::size_t kWindow = 16;

private:
    struct Sample {
        std::int64_t round_trip_ns = 0;
        std::int64_t client_minus_server_ns = 0;
    };
    const Sample* best() const;

    std::deque<Sample> samples_;
};

} // namespace fieldcast::client::net
