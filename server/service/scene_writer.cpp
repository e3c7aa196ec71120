// SPDX-License-Identifier: Apache-2.0
#include "server/service/scene_writer.h"

#include "server/service/status.h"

#include <algorithm>

namespace fieldcast::service {

namespace {

constexpr std::size_t kSceneChunkBytes = 1U << 20;

} // namespace

std::shared_ptr<SceneWriter> SceneWriter::open(grpc::CallbackServerContext& context, Setup setup) {
    std::shared_ptr<SceneWriter> writer(new SceneWriter(context, std::move(setup)));
    writer->self_ = writer;
    writer->write_next();
    return writer;
}

void SceneWriter::write_next() {
    const std::vector<std::byte>& bundle = *setup_.bundle;
    const std::size_t count = std::min(kSceneChunkBytes, bundle.size() - next_);
    chunk_.set_total_bytes(bundle.size());
    chunk_.set_offset(next_);
    chunk_.set_data(bundle.data() + next_, count);
    next_ += count;
    {
        auto state = state_.lock();
        state->is_writing = true;
        state->write_begun = Clock::now();
    }
    StartWrite(&chunk_);
}

void SceneWriter::OnWriteDone(bool ok) {
    const bool is_complete = ok && next_ >= setup_.bundle->size();
    bytes_sent_ += ok ? chunk_.data().size() : 0;
    {
        auto state = state_.lock();
        state->is_writing = false;
        state->is_over = !ok || is_complete;
        if (!ok && state->end == DownloadEnd::kFinished) {
            state->end = DownloadEnd::kCancelled;
        }
    }
    ok && !is_complete ? write_next() : finish_unless_pinned();
}

void SceneWriter::finish_unless_pinned() {
    grpc::Status status = grpc::Status::OK;
    {
        auto state = state_.lock();
        if (!state->is_over || state->is_pinned || state->is_finished) {
            return;
        }
        state->is_finished = true;
        if (state->end != DownloadEnd::kFinished) {
            status = state->end == DownloadEnd::kStalled ? to_status(Problem::kTooLate, "the client does not read")
                                                         : to_status(Problem::kUnavailable, "the stream broke");
        }
    }
    Finish(status);
}

void SceneWriter::tick(Clock::time_point now) {
    {
        auto state = state_.lock();
        const bool is_stuck = state->is_writing && now - state->write_begun >= setup_.stall_deadline;
        if (!is_stuck || state->end != DownloadEnd::kFinished) {
            return;
        }
        state->end = DownloadEnd::kStalled;
        state->is_pinned = true;
    }
    context_.TryCancel(); // the write in flight comes back with ok == false
    state_.lock()->is_pinned = false;
    finish_unless_pinned();
}

void SceneWriter::OnDone() {
    setup_.on_done(state_.lock()->end, bytes_sent_);
    self_.reset(); // may delete this
}

} // namespace fieldcast::service
