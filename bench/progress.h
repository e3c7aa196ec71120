// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

namespace fieldcast::bench {

/// "less than a minute", "7 min", "2 h 10 min".
std::string describe_duration(std::chrono::seconds duration);

/// A line on standard error that says how far long work is and when it will be done: rewritten in place on a terminal,
/// else a new line every half a minute.
class Progress {
public:
    /// `what` is done in `total` pieces of about equal length.
    Progress(std::string what, double total);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void add(double pieces);

private:
    using Clock = std::chrono::steady_clock;

    std::string what_;
    double total_;
    double done_ = 0.0;
    bool is_terminal_;
    bool has_line_ = false;
    Clock::time_point begin_;
    Clock::time_point shown_;
};

} // namespace fieldcast::bench
