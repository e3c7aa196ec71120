// SPDX-License-Identifier: Apache-2.0
#include "client/net/clock_sync.h"

#include <algorithm>
#include <chrono>

namespace fieldcast::client::net {
namespace {

// Steady clocks count from boot, so times beyond 73 years are wrong. Rejecting them keeps sums from overflowing.
constexpr std::int64_t kLatestNs = INT64_MAX / 4;

bool is_plausible(std::int64_t time_ns) {
    return time_ns >= 0 && time_ns <= kLatestNs;
}

} // namespace

std::int64_t steady_now_ns() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

void ClockSync::add(const Exchange& exchange) {
    if (!is_plausible(exchange.client_send_ns) || !is_plausible(exchange.server_receive_ns) ||
        !is_plausible(exchange.server_send_ns) || !is_plausible(exchange.client_receive_ns)) {
        return;
    }
    const std::int64_t at_server_ns = exchange.server_send_ns - exchange.server_receive_ns;
    const std::int64_t round_trip_ns = exchange.client_receive_ns - exchange.client_send_ns - at_server_ns;
    if (at_server_ns < 0 || round_trip_ns < 0) {
        return;
    }
    const std::int64_t client_middle_ns = (exchange.client_send_ns + exchange.client_receive_ns) / 2;
    const std::int64_t server_middle_ns = (exchange.server_receive_ns + exchange.server_send_ns) / 2;
    samples_.push_back({round_trip_ns, client_middle_ns - server_middle_ns});
    if (samples_.size() > kWindow) {
        samples_.pop_front();
    }
}

const ClockSync::Sample* ClockSync::best() const {
    const auto shortest = std::min_element(samples_.begin(), samples_.end(), [](const Sample& a, const Sample& b) {
        return a.round_trip_ns < b.round_trip_ns;
    });
    return shortest == samples_.end() ? nullptr : &*shortest;
}

std::optional<std::int64_t> ClockSync::client_from_server_ns(std::int64_t server_ns) const {
    const Sample* sample = best();
    if (sample == nullptr || server_ns <= 0 || !is_plausible(server_ns)) {
        return std::nullopt;
    }
    return server_ns + sample->client_minus_server_ns;
}

std::optional<ClockSync::Offset> ClockSync::offset() const {
    const Sample* sample = best();
    return sample == nullptr ? std::nullopt
                             : std::optional(Offset{-sample->client_minus_server_ns, sample->round_trip_ns});
}

std::optional<std::int64_t> ClockSync::round_trip_ns() const {
    const Sample* sample = best();
    return sample == nullptr ? std::nullopt : std::optional(sample->round_trip_ns);
}

} // namespace fieldcast::client::net
