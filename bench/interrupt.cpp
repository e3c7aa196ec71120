// SPDX-License-Identifier: Apache-2.0
#include "bench/interrupt.h"

#include <csignal>

namespace fieldcast::bench {

namespace {

volatile std::sig_atomic_t was_asked = 0;

void ask(int signal) {
    was_asked = 1;
    std::signal(signal, SIG_DFL);
}

} // namespace

InterruptGuard::InterruptGuard()
    : before_interrupt_(std::signal(SIGINT, ask)), before_terminate_(std::signal(SIGTERM, ask)) {
    was_asked = 0;
}

InterruptGuard::~InterruptGuard() {
    std::signal(SIGINT, before_interrupt_);
    std::signal(SIGTERM, before_terminate_);
}

bool InterruptGuard::is_interrupted() const {
    return was_asked != 0;
}

} // namespace fieldcast::bench
