// SPDX-License-Identifier: Apache-2.0
#include "client/interrupt.h"

#include <unistd.h>

namespace fieldcast::client {

Interrupt::Interrupt() {
    thread_ = std::jthread([this](const std::stop_token& stop) { listen(stop); });
}

void Interrupt::listen(const std::stop_token& stop) {
    constexpr std::chrono::milliseconds kLookAtStop{100};
    while (!stop.stop_requested()) {
        if (signals_.wait(kLookAtStop) && !source_.request_stop()) {
            _exit(kExitInterrupted);
        }
    }
}

} // namespace fieldcast::client
