// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "core/base/log.h"
#include "core/base/rate_limit.h"

#include <chrono>
#include <functional>
#include <map>
#include <string>

namespace fieldcast::log {

/// Writes what a peer causes to be logged, but only so many lines of each event. What it leaves out it counts, and says
/// the count in a line of its own before the next line of that event, or when it ends. Thread-safe.
///
///     log::Quota lines("session 7");
///     lines.write(log::Level::kInfo, "session configured", {{"rows", 4}}); // as often as a client likes
class Quota {
public:
    using TimePoint = RateLimit::TimePoint;

    /// Of one session: each event ten times at once, then every half minute.
    static constexpr RateLimit::Rate kOfSession{.per_second = 1.0 / 30.0, .burst = 10.0};

    /// Of everybody together, who may not fill the disk: each event 20 times at once, then every second.
    static constexpr RateLimit::Rate kOfEverybody{.per_second = 1.0, .burst = 20.0};

    explicit Quota(std::string owner, RateLimit::Rate of_event = kOfSession)
        : owner_(std::move(owner)), of_event_(of_event) {}
    Quota(const Quota&) = delete;
    Quota& operator=(const Quota&) = delete;
    ~Quota();

    void write(Level level, std::string_view event, Fields fields = {},
               TimePoint now = std::chrono::steady_clock::now());

private:
    struct Lines {
        RateLimit rate;
        Level level;
        std::uint64_t left_out = 0;
    };

    void tell_left_out(Level level, std::string_view event, std::uint64_t count) const;

    const std::string owner_;
    const RateLimit::Rate of_event_;
    Guarded<std::map<std::string, Lines, std::less<>>> lines_; ///< by event
};

} // namespace fieldcast::log
