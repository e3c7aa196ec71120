// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/load_run.h"

#include <chrono>

namespace fieldcast::client {

/// Prints the progress of a load run to standard error: a terminal shows a table that is rewritten in place; otherwise
/// there is a line per group every 5 s.
class LoadConsole {
public:
    LoadConsole();

    void show(const load::LoadProgress& progress);

private:
    bool is_terminal_;
    std::size_t lines_ = 0; ///< height of the table on the terminal
    std::chrono::steady_clock::time_point next_;
};

} // namespace fieldcast::client
