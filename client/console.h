// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/play/playback.h"

#include <chrono>

namespace fieldcast::client {

/// Where a run stands, on standard error: one line that is rewritten on a terminal, else a line every few seconds.
class ProgressLine {
public:
    ProgressLine();
    ~ProgressLine(); ///< ends the line
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    void show(const play::Progress& progress);

private:
    bool is_terminal_;
    bool has_line_ = false;
    std::chrono::steady_clock::time_point next_;
};

} // namespace fieldcast::client
