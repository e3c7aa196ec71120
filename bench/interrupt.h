// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace fieldcast::bench {

inline constexpr int kInterrupted = 130; ///< exit code, as shells give it to programs that Ctrl-C ended

/// While it lives, the first Ctrl-C (or SIGTERM) asks for an end at the next good moment; the second one ends at once.
/// One at a time, in the main thread.
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

/// Thrown where work ends early because of Ctrl-C; the message says what is left. Leads to exit code kInterrupted.
struct Interrupted {
    const char* what_is_left;
};

} // namespace fieldcast::bench
