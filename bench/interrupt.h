// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace fieldcast::bench {

inline constexpr int kInterrupted = 130; ///< exit code that shells use for programs ended by Ctrl-C

/// During its lifetime, the first Ctrl-C (or SIGTERM) requests an end and the second one ends the process at once. Only
/// one object at a time, in the main thread.
class InterruptGuard {
public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    bool is_interrupted() const;

private:
    using Handler = void (*)(int);
    Handler before_interrupt_;
    Handler before_terminate_;
};

/// Thrown when work ends early because of Ctrl-C. Contains the state of the results; leads to exit code kInterrupted.
struct Interrupted {
    const char* what_is_left;
};

} // namespace fieldcast::bench
