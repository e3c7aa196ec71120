// SPDX-License-Identifier: Apache-2.0
#include "client/interrupt.h"

#include <ctime>
#include <unistd.h>

namespace fieldcast::client {

Interrupt::Interrupt() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
    thread_ = std::jthread([this](const std::stop_token& stop) { listen(stop); });
}

void Interrupt::listen(const std::stop_token& stop) {
    constexpr timespec kLookAtStop{0, 100'000'000};
    while (!stop.stop_requested()) {
        if (sigtimedwait(&signals_, nullptr, &kLookAtStop) < 0) {
            continue;
        }
        if (!source_.request_stop()) {
            _exit(kExitInterrupted);
        }
    }
}

} // namespace fieldcast::client
