// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <random>

namespace fieldcast::client::net {

/// Waiting times between attempts: 0.25 s, doubled each time up to 5 s, each shortened at random by up to half so that
/// many clients do not come back at the same moment.
class Backoff {
public:
    explicit Backoff(std::uint32_t seed) : random_(seed) {}

    std::chrono::milliseconds next();
    void reset() { ceiling_ = kFirst; } ///< after something worked

    static constexpr std::chrono::milliseconds kFirst{250};
    static constexpr std::chrono::milliseconds kLongest{5000};

private:
    std::minstd_rand random_;
    std::chrono::milliseconds ceiling_ = kFirst;
};

} // namespace fieldcast::client::net
