// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace fieldcast {

/// Lets events through at a rate: `burst` of them at once, then `per_second` on average. Not thread-safe.
///
///     RateLimit openings({.per_second = 10, .burst = 20});
///     if (!openings.take(now)) { refuse(); }
class RateLimit {
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    struct Rate {
        double per_second = 1.0; ///< above 0
        double burst = 1.0;      ///< at least 1
    };

    explicit RateLimit(Rate rate) : rate_(rate), left_(rate.burst) {}

    /// Returns whether an event that counts as `amount` may happen now, and counts it if so. `now` must not go
    /// backwards.
    bool take(TimePoint now, double amount = 1.0);

    /// Whether the full burst is available, so that a new RateLimit would behave the same.
    bool is_idle(TimePoint now) const { return left_at(now) >= rate_.burst; }

private:
    double left_at(TimePoint now) const;

    Rate rate_;
    double left_; ///< events that may happen at once, at `at_`
    TimePoint at_{};
};

} // namespace fieldcast
