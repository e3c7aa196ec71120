// SPDX-License-Identifier: Apache-2.0
#include "server/listener/self_probe.h"

#include "core/base/log.h"

namespace fieldcast::listener {

SelfProbe::SelfProbe(OwnPort port, const ProbePace& pace)
    : port_(std::move(port)), pace_(pace), thread_([this](const std::stop_token& stop) { ask_until(stop); }) {}

void SelfProbe::ask_until(const std::stop_token& stop) {
    const std::stop_callback on_stop(stop, [this] { wakeup_.stop(); });
    while (wakeup_.wait({}, pace_.interval) != Wakeup::Outcome::kStopped) {
        const auto problem = port_.problem(wakeup_, pace_.patience);
        if (!stop.stop_requested()) {
            take_note(problem);
        }
    }
}

void SelfProbe::take_note(const std::optional<std::string>& problem) {
    auto state = state_.lock();
    if (!problem) {
        if (state->in_a_row > 0) {
            log::info("the own port answers again", {{"failures", state->in_a_row}});
        }
        ++state->answers;
        state->in_a_row = 0;
        state->hearing = Hearing::kHears;
        return;
    }
    ++state->failures;
    ++state->in_a_row;
    state->hearing = state->in_a_row >= pace_.failures_until_deaf ? Hearing::kDeaf : Hearing::kSilent;
    log::error("the own port does not answer", {{"problem", *problem}, {"in_a_row", state->in_a_row}});
}

} // namespace fieldcast::listener
