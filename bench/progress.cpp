// SPDX-License-Identifier: Apache-2.0
#include "bench/progress.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <unistd.h>

namespace fieldcast::bench {

namespace {

using namespace std::chrono_literals;

constexpr auto kTerminalInterval = 200ms;
constexpr auto kLogInterval = 30s;

} // namespace

std::string describe_duration(std::chrono::seconds duration) {
    const auto minutes = (duration.count() + 30) / 60;
    if (minutes < 1) {
        return "less than a minute";
    }
    const std::string rest = std::to_string(minutes % 60) + " min";
    return minutes < 60 ? rest : std::to_string(minutes / 60) + " h " + rest;
}

Progress::Progress(std::string what, double total)
    : what_(std::move(what)), total_(std::max(total, 1e-9)), is_terminal_(isatty(STDERR_FILENO) == 1),
      begin_(Clock::now()), shown_(begin_) {}

Progress::~Progress() {
    if (has_line_ && is_terminal_) {
        std::cerr << '\n';
    }
}

void Progress::add(double pieces) {
    const bool was_done = done_ >= total_;
    done_ += pieces;
    const auto now = Clock::now();
    const bool is_due = is_terminal_ ? !has_line_ || now - shown_ >= kTerminalInterval : now - shown_ >= kLogInterval;
    if (was_done || done_ <= 0.0 || (!is_due && done_ < total_)) {
        return;
    }
    const std::chrono::duration<double> spent = now - begin_;
    const double left_s = spent.count() * std::max(0.0, total_ - done_) / done_;
    std::cerr << (is_terminal_ ? "\r" : "") << what_ << ": " << std::lround(100.0 * std::min(1.0, done_ / total_))
              << " %";
    if (done_ < total_) {
        std::cerr << ", " << describe_duration(std::chrono::seconds(std::llround(left_s))) << " left      ";
    } else {
        std::cerr << " after " << describe_duration(std::chrono::seconds(std::llround(spent.count()))) << "      ";
    }
    std::cerr << (is_terminal_ ? "" : "\n") << std::flush;
    has_line_ = true;
    shown_ = now;
}

} // namespace fieldcast::bench
