// SPDX-License-Identifier: Apache-2.0
#include "server/service/stream.h"

#include "core/base/log.h"
#include "server/service/messages.h"
#include "server/service/status.h"

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
    state_.lock()->session.emplace(
        setup_.channels, setup_.limits,
        [weak = weak_from_this()](const feed::FramePtr& frame) {
            if (const auto stream = weak.lock()) {
                stream->take_frame(frame);
            }
        },
        Clock::now());
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

void Stream::end(const grpc::Status& status) {
    auto state = state_.lock();
    if (!state->verdict) {
        state->verdict = status;
    }
}

void Stream::OnReadDone(bool ok) {
    if (ok) {
        receive();
    } else {
        end(grpc::Status::OK); // half-closed by the client, or cancelled, which OnCancel reports
    }
    {
        auto state = state_.lock(); // only now: `incoming_` belongs to the read
        state->is_reading = false;
        state->has_input_ended = !ok;
    }
    pump();
}

void Stream::receive() {
    const auto message = parse_client_message(incoming_);
    incoming_.Clear();
    if (!message) {
        return end(to_status(Problem::kInvalid, "these bytes are no fieldcast.v1.ClientMessage"));
    }
    try {
        auto state = state_.lock();
        state->session->on_message(*message, Clock::now());
        if (message->has_configure()) {
            log_configuration(*state->session);
        }
    } catch (const std::exception& problem) {
        log::error("session failed", {{"session", setup_.id}, {"problem", problem.what()}});
        end(to_status(Problem::kOurBug, "the server failed; see its log"));
    }
}

void Stream::log_configuration(const session::Session& session) const {
    const auto& configuration = session.configuration();
    if (!configuration) {
        return log::info("configuration refused", {{"session", setup_.id}});
    }
    const wire::ViewSet& set = configuration->view_set;
    log::info("session configured", {{"session", setup_.id},
                                     {"epoch", session.epoch()},
                                     {"channel", configuration->feed->info().name},
                                     {"mode", v1::DeliveryMode_Name(configuration->mode)},
                                     {"rows", set.grid.rows},
                                     {"cols", set.grid.cols},
                                     {"width_px", set.width_px},
                                     {"height_px", set.height_px}});
}

void Stream::take_frame(const feed::FramePtr& frame) {
    state_.lock()->session->on_frame(frame, Clock::now());
    pump();
}

void Stream::OnWriteDone(bool ok) {
    outgoing_.Clear();
    if (!ok) {
        end(to_status(Problem::kUnavailable, "the stream broke"));
    }
    state_.lock()->is_writing = false; // only now: `outgoing_` belongs to the write
    pump();
}

void Stream::OnCancel() {
    end(to_status(Problem::kUnavailable, "cancelled"));
    pump();
}

void Stream::go_away(const std::string& reason, session::TimePoint at) {
    state_.lock()->session->go_away(reason, at);
    pump();
}

void Stream::tick() {
    const auto now = Clock::now();
    state_.lock()->session->on_tick(now);
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
    }
    state->is_cut = state->is_pinned = state->is_writing; // otherwise Finish is enough
    return state->is_pinned;
}

void Stream::cut() {
    context_.TryCancel(); // the write in flight comes back with ok == false
    state_.lock()->is_pinned = false;
}

void Stream::OnDone() {
    session::SessionCounts counts;
    {
        auto state = state_.lock();
        counts = state->session->counts();
        state->session->end();
    }
    log_closed(counts);
    setup_.on_done(setup_.id);
    self_.reset(); // may delete this
}

void Stream::log_closed(const session::SessionCounts& counts) const {
    using session::DropReason;
    const auto drops = [&](DropReason reason) { return counts.drops.of(reason); };
    log::info("session closed", {{"session", setup_.id},
                                 {"frames", counts.frames_sent},
                                 {"bytes", counts.bytes_sent},
                                 {"failed_frames", counts.frames_failed},
                                 {"dropped_sending", drops(DropReason::kSending)},
                                 {"dropped_no_credit", drops(DropReason::kNoCredit)},
                                 {"dropped_rate_cap", drops(DropReason::kRateCap)},
                                 {"dropped_reconfigured", drops(DropReason::kReconfigured)},
                                 {"dropped_leaving", drops(DropReason::kLeaving)},
                                 {"dropped_no_key_frame", drops(DropReason::kNoKeyFrame)}});
}

} // namespace fieldcast::service
