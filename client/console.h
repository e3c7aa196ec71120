// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/play/playback.h"

#include <chrono>

namespace fieldcast::client {

/// Prints the progress of a run to standard error: a terminal shows one line that is rewritten at most 10 times a
/// second; otherwise there is a new line every 3 s.
class ProgressLine {
public:
    ProgressLine();
    ~ProgressLine(); ///< ends the line on a terminal
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    void show(const play::Progress& progress);

private:
    bool is_terminal_;
    bool has_line_ = false;
    std::chrono::steady_clock::time_point next_;
};

} // namespace fieldcast::client
