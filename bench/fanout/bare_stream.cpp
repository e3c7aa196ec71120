// SPDX-License-Identifier: Apache-2.0
// Started by `fieldcast-bench fanout`: streams the messages of a file until INT or TERM.
//     fieldcast-bare-stream MESSAGES FRAMES_PER_SECOND PORT_FILE
#include "bench/fanout/bare_server.h"
#include "core/base/error.h"
#include "core/base/stop_signals.h"

#include <cstdlib>
#include <fstream>
#include <iostream>

int main(int argc, char** argv) {
    using namespace fieldcast::bench::fanout;
    if (argc != 4) {
        std::cerr << "fieldcast-bare-stream MESSAGES FRAMES_PER_SECOND PORT_FILE\n";
        return 2;
    }
    const fieldcast::StopSignals signals; // before any thread exists
    try {
        const double frames_per_second = std::strtod(argv[2], nullptr);
        if (!(frames_per_second > 0.0)) {
            throw fieldcast::UserError("frames per second must be more than 0");
        }
        const BareServer server(read_messages(argv[1]), frames_per_second);
        std::ofstream(argv[3]) << server.port() << '\n';
        while (!signals.wait(std::chrono::hours(1))) {
        }
    } catch (const std::exception& problem) {
        std::cerr << "fieldcast-bare-stream: " << problem.what() << '\n';
        return 1;
    }
    return 0;
}
