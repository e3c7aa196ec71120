// SPDX-License-Identifier: Apache-2.0
#include "server/service/stream.h"

#include "core/base/log.h"
#include "server/service/messages.h"
#include "server/service/status.h"

#include <algorithm>
#include <exception>
#include <grpcpp/server_context.h>

namespace fieldcast::service {

namespace {

using Clock = std::chrono::steady_clock;

} // namespace

std::shared_ptr<Stream> Stream::open(grpc::CallbackServerContext& context, Setup setup) {
    std::shared_ptr<Stream> stream(new Stream(context, std::move(setup)));
    stream->self_ = stream;
    stream->begin();
    return stream;
}

void Stream::begin() {
    {
        auto state = state_.lock();
        state->session.emplace(
            setup_.channels, setup_.limits,
            [weak = weak_from_this()](const feed::FramePtr& frame) {
                if (const auto stream = weak.lock()) {
                    stream->take_frame(frame);
                }
            },
            Clock::now(), setup_.budgets, setup_.steerer);
        if (setup_.recorder != nullptr) {
            state->session->timings().enable();
        }
    }
    pump();
}

void Stream::pump() {
    Actions actions = decide(Clock::now());
    if (actions.read) {
        StartRead(&incoming_);
    }
    if (actions.write) {
        outgoing_ = to_buffer(*actions.write);
        StartWrite(&outgoing_);
    } else if (actions.finish) {
        Finish(*actions.finish);
    }
}

Stream::Actions Stream::decide(session::TimePoint now) {
    Actions actions;
    auto state = state_.lock();
    if (state->is_finished) {
        return actions;
    }
    try {
        if (!state->is_writing && !state->verdict) {
            actions.write = state->session->next(now);
        }
    } catch (const std::exception& problem) {
        log::error("session failed", {{"session", setup_.id}, {"problem", problem.what()}});
        state->verdict = to_status(Problem::kOurBug, "the server failed; see its log");
        state->failure = session::CloseReason::kFailed;
    }
    if (actions.write) {
        state->is_writing = true;
        state->write_begun = now;
    } else if (state->verdict && !state->is_writing && !state->is_pinned) {
        state->is_finished = true;
        actions.finish = state->verdict;
    }
    actions.read = !state->is_reading && !state->has_input_ended && !state->verdict && state->session->accepts_input();
    state->is_reading = state->is_reading || actions.read;
    return actions;
}

void Stream::end(const grpc::Status& status, std::optional<session::CloseReason> why) {
    auto state = state_.lock();
    if (!state->verdict) {
        state->verdict = status;
        state->failure = why;
    }
}

void Stream::OnReadDone(bool ok) {
    if (ok) {
        receive();
    } else {
        end(grpc::Status::OK); // half-closed by the client, or cancelled, which OnCancel reports
    }
    {
        auto state = state_.lock(); // not earlier: `incoming_` belongs to the read
        state->is_reading = false;
        state->has_input_ended = !ok;
    }
    pump();
}

bool Stream::may_read(std::size_t bytes) {
    auto state = state_.lock();
    state->session->on_bytes(bytes, Clock::now());
    return !state->session->is_flooded();
}

void Stream::end_flood() {
    end(to_status(Problem::kExhausted, "more messages or bytes than a client may send; limit: " +
                                           std::to_string(setup_.limits.max_messages_per_second) +
                                           " messages per second"),
        session::CloseReason::kFlooding);
}

void Stream::receive() {
    if (!may_read(incoming_.Length())) {
        return end_flood();
    }
    const auto message = parse_client_message(incoming_);
    incoming_.Clear();
    if (!message) {
        return end(to_status(Problem::kInvalid, "the message is not a fieldcast.v1.ClientMessage"),
                   session::CloseReason::kInvalid);
    }
    if (message->has_configure()) {
        publish_counts(); // the message may change the channel, and these counts belong to the old one
    }
    bool is_flooded = false;
    try {
        auto state = state_.lock();
        state->session->on_message(*message, Clock::now());
        is_flooded = state->session->is_flooded();
        if (message->has_configure() && !is_flooded) {
            log_configuration(*state->session);
        }
    } catch (const std::exception& problem) {
        log::error("session failed", {{"session", setup_.id}, {"problem", problem.what()}});
        end(to_status(Problem::kOurBug, "the server failed; see its log"), session::CloseReason::kFailed);
    }
    if (is_flooded) {
        end_flood();
    }
}

void Stream::log_configuration(session::ServerSession& session) const {
    const auto& configuration = session.configuration();
    if (!configuration) {
        return session.lines().write(log::Level::kInfo, "configuration refused", {{"session", setup_.id}});
    }
    const wire::ViewSet& set = configuration->view_set;
    session.lines().write(log::Level::kInfo, "session configured",
                        {{"session", setup_.id},
                         {"epoch", session.epoch()},
                         {"channel", configuration->feed->info().name},
                         {"mode", std::string(word_of(configuration->mode))},
                         {"rows", set.grid.rows},
                         {"cols", set.grid.cols},
                         {"width_px", set.width_px},
                         {"height_px", set.height_px},
                         {"max_fps", configuration->frames_per_second},
                         {"adapted", session.adapted_level()}});
}

void Stream::take_frame(const feed::FramePtr& frame) {
    state_.lock()->session->on_frame(frame, Clock::now());
    pump();
}

void Stream::OnWriteDone(bool ok) {
    outgoing_.Clear();
    if (!ok) {
        end(to_status(Problem::kUnavailable, "the stream was interrupted"));
    }
    state_.lock()->is_writing = false; // not earlier: `outgoing_` belongs to the write
    pump();
}

void Stream::OnCancel() {
    state_.lock()->was_cancelled = true;
    end(to_status(Problem::kUnavailable, "cancelled"));
    pump();
}

void Stream::go_away(const std::string& reason, session::TimePoint at, session::CloseReason why) {
    {
        auto state = state_.lock();
        if (!state->verdict) { // otherwise it has another reason already
            state->session->go_away(reason, at, why);
        }
    }
    pump();
}

void Stream::publish_counts() {
    session::SessionCounts news;
    std::string channel;
    {
        auto state = state_.lock();
        const auto& configuration = state->session->configuration();
        channel = configuration ? configuration->feed->info().name : "";
        news = difference(state->session->counts(), state->published);
        state->published = state->session->counts();
    }
    setup_.metrics->add(channel, news);
}

SessionFacts Stream::facts() {
    SessionFacts facts;
    auto state = state_.lock();
    facts.frames_in_flight = state->session->credits().in_flight();
    facts.bytes_in_flight = state->session->credits().bytes_in_flight();
    facts.is_adapted = state->session->adapted_level() > 0;
    if (const auto& configuration = state->session->configuration()) {
        const ViewGrid& grid = configuration->view_set.grid;
        facts.channel = configuration->feed->info().name;
        facts.mode = word_of(configuration->mode);
        facts.grid = std::to_string(grid.rows) + "x" + std::to_string(grid.cols);
    }
    return facts;
}

session::CloseReason Stream::close_reason(const State& state) {
    const bool was_cancelled = state.was_cancelled && !state.is_cut;
    const auto usual = was_cancelled ? session::CloseReason::kCancelled : session::CloseReason::kFinished;
    return state.failure ? *state.failure : state.session->close_reason().value_or(usual);
}

void Stream::record_timings() {
    if (setup_.recorder == nullptr) {
        return;
    }
    for (timing::DeliveredFrame& frame : state_.lock()->session->timings().take_finished()) {
        frame.client = setup_.id;
        setup_.recorder->add(std::move(frame));
    }
}

void Stream::tick() {
    const auto now = Clock::now();
    {
        auto state = state_.lock();
        const std::uint32_t epoch = state->session->epoch();
        if (!state->verdict) {
            state->session->on_tick(now);
        }
        if (state->session->epoch() != epoch) { // adapted
            log_configuration(*state->session);
        }
    }
    record_timings();
    if (pin_if_overdue(now)) {
        cut();
    }
    pump();
}

bool Stream::pin_if_overdue(session::TimePoint now) {
    auto state = state_.lock();
    const bool is_stuck = state->is_writing && now - state->write_begun >= setup_.limits.stall_deadline;
    if (state->is_finished || state->is_cut || !(is_stuck || state->session->is_overdue(now))) {
        return false;
    }
    if (!state->verdict) {
        state->verdict = to_status(Problem::kTooLate,
                                   is_stuck ? "the client does not read" : "the client did not half-close in time");
        if (is_stuck) {
            state->failure = session::CloseReason::kNotReading;
        }
    }
    state->is_cut = state->is_pinned = state->is_writing; // otherwise Finish is enough
    return state->is_pinned;
}

void Stream::cut() {
    context_.TryCancel(); // the write in flight then returns with ok == false
    state_.lock()->is_pinned = false;
}

void Stream::OnDone() {
    session::SessionCounts counts;
    session::CloseReason reason = session::CloseReason::kFinished;
    publish_counts();
    {
        auto state = state_.lock();
        counts = state->session->counts();
        reason = close_reason(*state);
        state->session->end();
    }
    record_timings();
    log_closed(counts, reason);
    setup_.metrics->count_closed(reason);
    setup_.on_done(setup_.id);
    self_.reset(); // may delete this
}

void Stream::log_closed(const session::SessionCounts& counts, session::CloseReason reason) const {
    using session::DropReason;
    const auto drops = [&](DropReason drop) { return counts.drops.of(drop); };
    setup_.comings->write(log::Level::kInfo, "session closed",
                          {{"session", setup_.id},
                           {"reason", to_text(reason)},
                           {"frames", counts.frames_sent},
                           {"bytes", counts.bytes_sent},
                           {"failed_frames", counts.frames_failed},
                           {"dropped_sending", drops(DropReason::kSending)},
                           {"dropped_no_credit", drops(DropReason::kNoCredit)},
                           {"dropped_rate_cap", drops(DropReason::kRateCap)},
                           {"dropped_reconfigured", drops(DropReason::kReconfigured)},
                           {"dropped_leaving", drops(DropReason::kLeaving)},
                           {"dropped_no_key_frame", drops(DropReason::kNoKeyFrame)},
                           {"dropped_no_budget", drops(DropReason::kNoBudget)}});
}

} // namespace fieldcast::service
