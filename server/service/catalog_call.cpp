// SPDX-License-Identifier: Apache-2.0
#include "server/service/catalog_call.h"

#include "server/service/status.h"

#include <grpcpp/server_context.h>

namespace fieldcast::service {

std::shared_ptr<CatalogCall> CatalogCall::open(grpc::CallbackServerContext& context, Setup setup) {
    std::shared_ptr<CatalogCall> call(new CatalogCall(context, std::move(setup)));
    call->self_ = call;
    call->StartRead(&call->request_);
    return call;
}

void CatalogCall::OnReadDone(bool ok) {
    {
        auto state = state_.lock();
        if (state->is_over) { // the request came too late
            return;
        }
        state->step = Step::kBetween;
    }
    if (!ok) {
        end(CallEnd::kCancelled, to_status(Problem::kInvalid, "the call ended without a request"));
        return finish_unless_pinned();
    }
    auto answer = setup_.answer(request_);
    request_.Clear();
    if (!answer) {
        end(CallEnd::kFinished, std::move(answer.error()));
        return finish_unless_pinned();
    }
    answer_ = std::move(*answer);
    write_next();
}

void CatalogCall::write_next() {
    part_ = answer_();
    if (!part_) {
        end(CallEnd::kFinished, std::nullopt);
        return finish_unless_pinned();
    }
    {
        auto state = state_.lock();
        state->step = Step::kWriting;
        state->step_begun = Clock::now();
    }
    StartWrite(&part_->message);
}

void CatalogCall::OnWriteDone(bool ok) {
    payload_bytes_ += ok ? part_->payload_bytes : 0;
    part_.reset();
    state_.lock()->step = Step::kBetween;
    if (ok) {
        return write_next();
    }
    end(CallEnd::kCancelled, to_status(Problem::kUnavailable, "the stream was interrupted"));
    finish_unless_pinned();
}

void CatalogCall::end(CallEnd end, std::optional<grpc::Status> verdict) {
    auto state = state_.lock();
    state->is_over = true;
    if (!state->verdict) {
        state->end = end;
        state->verdict = std::move(verdict);
    }
}

void CatalogCall::finish_unless_pinned() {
    grpc::Status status;
    {
        auto state = state_.lock();
        if (!state->is_over || state->is_pinned || state->is_finished) {
            return;
        }
        state->is_finished = true;
        status = state->verdict.value_or(grpc::Status::OK);
    }
    Finish(status);
}

void CatalogCall::tick(Clock::time_point now) {
    const bool is_revoked = !setup_.is_admitted();
    bool is_writing = false;
    {
        auto state = state_.lock();
        is_writing = state->step == Step::kWriting;
        const bool is_late = now - state->step_begun >= (is_writing ? setup_.stall_deadline : setup_.request_deadline);
        if (state->step == Step::kBetween || state->verdict || !(is_late || is_revoked)) {
            return;
        }
        const char* const what = is_writing ? "the client does not read" : "the request did not come in time";
        state->end = is_revoked ? CallEnd::kRevoked : CallEnd::kStalled;
        state->verdict = is_revoked ? to_status(Problem::kUnauthenticated, "the token of this call was revoked")
                                    : to_status(Problem::kTooLate, what);
        state->is_pinned = is_writing; // with a write in flight the call has not finished, and the context exists
        state->is_over = !is_writing;  // a read in flight does not prevent finishing
    }
    if (is_writing) {
        context_.TryCancel(); // the write then returns with ok == false
        state_.lock()->is_pinned = false;
    }
    finish_unless_pinned();
}

void CatalogCall::OnDone() {
    setup_.on_done(state_.lock()->end, payload_bytes_);
    self_.reset(); // may delete this
}

} // namespace fieldcast::service
