// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

namespace fieldcast::bench {

/// A duration as text: "less than a minute", "7 min", "2 h 10 min".
std::string describe_duration(std::chrono::seconds duration);

/// Prints progress and remaining time of long work to standard error: one line that is rewritten on a terminal, else a
/// new line every 30 s.
class Progress {
public:
    /// `what` names the work, which has `total` pieces of about equal length.
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
