// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/load_run.h"

#include <chrono>

namespace fieldcast::client {

/// Where a load run stands, on standard error: a table that is rewritten on a terminal, else a line per group every few
/// seconds.
class LoadConsole {
public:
    LoadConsole();

    void show(const load::LoadProgress& progress);

private:
    bool is_terminal_;
    std::size_t lines_ = 0; ///< of the table on the terminal
    std::chrono::steady_clock::time_point next_;
};

} // namespace fieldcast::client
