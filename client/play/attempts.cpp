// SPDX-License-Identifier: Apache-2.0
#include "client/play/attempts.h"

#include <condition_variable>
#include <mutex>

namespace fieldcast::client::play {

Attempts::Attempts(bool reconnects, std::chrono::milliseconds patience)
    : reconnects_(reconnects), patience_(patience), gives_up_(std::chrono::steady_clock::now() + patience),
      backoff_(std::random_device{}()) {}

void Attempts::succeeded() {
    gives_up_ = std::chrono::steady_clock::now() + patience_;
    backoff_.reset();
}

bool Attempts::wait_for_next(const std::stop_token& stop, net::Obstacle obstacle) {
    if (!reconnects_ || std::chrono::steady_clock::now() >= gives_up_) {
        return false;
    }
    std::mutex mutex;
    std::condition_variable_any stopped;
    std::unique_lock lock(mutex);
    stopped.wait_for(lock, stop, backoff_.next(obstacle), [] { return false; });
    return !stop.stop_requested();
}

} // namespace fieldcast::client::play
