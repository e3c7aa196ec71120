// SPDX-License-Identifier: Apache-2.0
#include "core/base/stop_signals.h"

#include <atomic>
#include <csignal>
#include <ctime>
#include <initializer_list>
#include <pthread.h>

namespace fieldcast {

namespace {

constexpr std::initializer_list<int> kStopSignals = {SIGTERM, SIGINT};

std::atomic<pthread_t> waiting; // the thread that called wait(), before that the one that constructed StopSignals
static_assert(std::atomic<pthread_t>::is_always_lock_free, "signal handlers may not lock");

sigset_t stop_set() {
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : kStopSignals) {
        sigaddset(&set, signal);
    }
    return set;
}

/// Forwards the signal. Runs in a thread that does not block it.
extern "C" void pass_on(int signal) {
    pthread_kill(waiting.load(), signal);
}

void set_action(void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    for (const int signal : kStopSignals) {
        sigaction(signal, &action, nullptr);
    }
}

} // namespace

StopSignals::StopSignals() {
    const sigset_t set = stop_set();
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
    waiting = pthread_self();
    set_action(pass_on);
}

StopSignals::~StopSignals() {
    set_action(SIG_DFL);
}

bool StopSignals::wait(std::chrono::milliseconds timeout) const {
    waiting = pthread_self();
    const sigset_t set = stop_set();
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(timeout);
    const timespec limit{.tv_sec = seconds.count(), .tv_nsec = std::chrono::nanoseconds(timeout - seconds).count()};
    return sigtimedwait(&set, nullptr, &limit) > 0;
}

} // namespace fieldcast
