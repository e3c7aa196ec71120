// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "server/listener/own_port.h"

#include <thread>

namespace fieldcast::listener {

/// What is known of the own port.
enum class Hearing : std::uint8_t {
    kHears,
    kSilent, ///< the last question had no answer
    kDeaf,   ///< several in a row had none: for good, as far as one can tell
};

/// How often the own port is asked, and what counts as deaf.
struct ProbePace {
    std::chrono::milliseconds interval; ///< from an answer to the next question
    std::chrono::milliseconds patience; ///< for an answer
    int failures_until_deaf;            ///< in a row
};

/// Asks the own port again and again, in a thread of its own.
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

    OwnPort port_; ///< of the thread alone
    const ProbePace pace_;
    mutable Guarded<State> state_;
    const Wakeup wakeup_;
    std::jthread thread_;
};

} // namespace fieldcast::listener
