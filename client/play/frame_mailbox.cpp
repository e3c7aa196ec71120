// SPDX-License-Identifier: Apache-2.0
#include "client/play/frame_mailbox.h"

#include <utility>

namespace fieldcast::client::play {

void report_times(const Arrival& arrival, bool was_superseded, std::int64_t rendered_ns, std::int64_t shown_ns) {
    const std::shared_ptr<net::ClientSession> session = arrival.session.lock();
    if (!session) {
        return;
    }
    net::FrameReport report;
    report.frame_id = arrival.arrived.frame_id;
    report.epoch = arrival.arrived.frame.epoch;
    report.was_superseded = was_superseded;
    report.first_byte_ns = arrival.arrived.first_byte_ns;
    report.last_byte_ns = arrival.arrived.last_byte_ns;
    report.decoded_ns = arrival.arrived.decoded_ns;
    report.rendered_ns = rendered_ns;
    report.shown_ns = shown_ns;
    report.clock = arrival.arrived.clock;
    session->report(report);
}

std::optional<Arrival> FrameMailbox::put(Arrival arrival) {
    auto state = state_.lock();
    std::optional<Arrival> replaced = std::exchange(state->newest, std::move(arrival));
    changed_.notify_all();
    return replaced;
}

void FrameMailbox::close() {
    state_.lock()->is_closed = true;
    changed_.notify_all();
}

std::optional<Arrival> FrameMailbox::take(const std::stop_token& stop) {
    const std::stop_callback wake(stop, [this] {
        const auto state = state_.lock(); // so that the waiting thread has not checked yet, or already waits
        changed_.notify_all();
    });
    auto state = state_.lock();
    state.wait(changed_, [&](const State& s) { return s.newest || s.is_closed || stop.stop_requested(); });
    return stop.stop_requested() ? std::nullopt : std::exchange(state->newest, std::nullopt);
}

} // namespace fieldcast::client::play
