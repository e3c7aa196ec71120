// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "server/listener/own_port.h"

#include <thread>

namespace fieldcast::listener {

/// State of the server's own port.
enum class Hearing : std::uint8_t {
    kHears,
    kSilent, ///< the last probe had no answer
    kDeaf,   ///< several probes in a row had no answer; treated as permanent
};

/// Times of the probes, and the condition for kDeaf.
struct ProbePace {
    std::chrono::milliseconds interval; ///< from an answer to the next probe
    std::chrono::milliseconds patience; ///< longest time for an answer
    int failures_until_deaf;            ///< failed probes in a row
};

/// Probes the server's own port repeatedly, in a thread of its own.
class SelfProbe {
public:
    SelfProbe(OwnPort port, const ProbePace& pace);

    Hearing hearing() const { return state_.lock()->hearing; }
    std::uint64_t answers() const { return state_.lock()->answers; }
    std::uint64_t failures() const { return state_.lock()->failures; }

private:
    struct State {
        Hearing hearing = Hearing::kHears;
        std::uint64_t answers = 0;
        std::uint64_t failures = 0;
        int in_a_row = 0;
    };

    void ask_until(const std::stop_token& stop);
    void take_note(const std::optional<std::string>& problem);

    OwnPort port_; ///< used by the thread only
    const ProbePace pace_;
    mutable Guarded<State> state_;
    const Wakeup wakeup_;
    std::jthread thread_;
};

} // namespace fieldcast::listener
