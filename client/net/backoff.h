// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <random>

namespace fieldcast::client::net {

/// Why an attempt failed.
enum class Obstacle : std::uint8_t {
    kUnreachable, ///< nobody answers, or the connection broke: asking costs nobody anything
    kRefused,     ///< a server answers that it cannot: asking again makes that worse
};

/// Waiting times between attempts: 0.25 s, doubled each time up to 5 s, each shortened at random by up to half so that
/// many clients do not come back at the same moment. While nobody answers, the first minute or so is spent asking every
/// 0.5 s at most, so that a server that was started again has its clients back within a second.
class Backoff {
public:
    explicit Backoff(std::uint32_t seed) : random_(seed) {}

    std::chrono::milliseconds next(Obstacle obstacle = Obstacle::kRefused);
    void reset(); ///< after something worked

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
