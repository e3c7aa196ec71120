// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <random>

namespace fieldcast::client::net {

/// Why an attempt to reach a server failed.
enum class Obstacle : std::uint8_t {
    kUnreachable, ///< no server answers, or the connection broke: another attempt costs no server anything
    kRefused,     ///< a server answers that it cannot serve us: another attempt adds to its load
};

/// Delays between attempts: 0.25 s, doubled each time up to 5 s. Each is shortened at random by up to half, so that
/// many clients do not return at the same moment. While the server is unreachable, delays stay at 0.5 s or less for
/// about the first minute, so that a restarted server has its clients back within a second.
class Backoff {
public:
    explicit Backoff(std::uint32_t seed) : random_(seed) {}

    /// The delay before the next attempt, after one that failed because of `obstacle`.
    std::chrono::milliseconds next(Obstacle obstacle = Obstacle::kRefused);
    void reset(); ///< Call it after a success.

    static constexpr std::chrono::milliseconds kFirst{250};
    static constexpr std::chrono::milliseconds kLongest{5000};
    static constexpr std::chrono::milliseconds kLongestUnreachable{500}; ///< of the first kQuickAttempts
    static constexpr int kQuickAttempts = 150;                           ///< about a minute

private:
    std::minstd_rand random_;
    std::chrono::milliseconds ceiling_ = kFirst;
    int unreachable_count_ = 0;
};

} // namespace fieldcast::client::net
