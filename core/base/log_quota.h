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

/// Limits the rate of the log lines that a peer causes, separately for each event. Lines beyond the rate are omitted
/// and counted. A line of its own reports the count before the next line of that event, or in the destructor.
/// Thread-safe.
///
///     log::Quota lines("session 7");
///     lines.write(log::Level::kInfo, "session configured", {{"rows", 4}}); // at any rate that a client causes
class Quota {
public:
    using TimePoint = RateLimit::TimePoint;

    /// Rate of one session, per event: 10 lines at once, then one every 30 s.
    static constexpr RateLimit::Rate kOfSession{.per_second = 1.0 / 30.0, .burst = 10.0};

    /// Rate of all peers together, so that they cannot fill the disk, per event: 20 lines at once, then one every
    /// second.
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
