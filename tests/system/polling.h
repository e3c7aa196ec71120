// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <thread>

namespace fieldcast::test {

/// Looks again and again until `condition()` holds. False: it did not within `patience`.
/// Only for what tells nobody when it changes: a page of metrics, a count inside the server, a socket of another
/// process. Whatever has an event of its own (a condition variable, a pipe, a file, the end of a process) is waited for.
template <class Condition>
[[nodiscard]] bool comes_true(const Condition& condition, std::chrono::milliseconds patience) {
    constexpr std::chrono::milliseconds kLookInterval{10};
    const auto deadline = std::chrono::steady_clock::now() + patience;
    bool holds = condition();
    while (!holds && std::chrono::steady_clock::now() < deadline) {
        std::this_thread::sleep_for(kLookInterval); // the one place where a test looks again: see tests/unit/tree
        holds = condition();
    }
    return holds;
}

} // namespace fieldcast::test
