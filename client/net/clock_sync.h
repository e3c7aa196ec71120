// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

namespace fieldcast::client::net {

/// The time on our steady clock, in nanoseconds.
std::int64_t steady_now_ns();

/// Estimates the offset between the server's and our steady clock. Of the last `kWindow` exchanges, it uses the one
/// with the shortest round trip, because the error is at most half the round trip.
class ClockSync {
public:
    /// The times of one TimeSync message and its answer, each on the clock of its side.
    struct Exchange {
        std::int64_t client_send_ns = 0;
        std::int64_t server_receive_ns = 0;
        std::int64_t server_send_ns = 0;
        std::int64_t client_receive_ns = 0;
    };

    /// Ignores impossible exchanges: with a negative round trip, or with times out of range.
    void add(const Exchange& exchange);

    /// Converts a time on the server's clock to ours. Empty before the first exchange, and for 0 ("unknown").
    std::optional<std::int64_t> client_from_server_ns(std::int64_t server_ns) const;
    std::optional<std::int64_t> round_trip_ns() const; ///< the shortest of the window

    /// The estimated offset, and the round trip of the exchange that it is from.
    struct Offset {
        std::int64_t server_minus_client_ns = 0;
        std::int64_t round_trip_ns = 0;
    };
    std::optional<Offset> offset() const; ///< empty before the first exchange

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
