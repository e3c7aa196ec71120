// SPDX-License-Identifier: Apache-2.0
#include "client/net/message_stream.h"

#include "client/net/call_status.h"
#include "client/net/clock_sync.h"
#include "client/net/connection_state.h"
#include "core/base/guarded.h"

#include "fieldcast/v1/light_field.grpc.pb.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <thread>

namespace fieldcast::client::net {

// gRPC calls the reactions on its own threads. They only move messages and start the next operation. Operations that
// start elsewhere (in `send`, `half_close` and `next`) take a hold for their duration, so that the call outlives them.
// `is_open`, under the lock, says that the main hold, taken before the call began, is still there.
class MessageStream::Reactor final : public grpc::ClientBidiReactor<v1::ClientMessage, v1::ServerMessage> {
public:
    Reactor(const Connection& connection, ReadingOptions options)
        : options_(std::move(options)), stub_(v1::LightField::NewStub(connection.state().channel)) {
        connection.state().prepare(context_);
        stub_->async()->Open(&context_, this);
        AddHold();
        StartRead(&reading_);
        StartCall();
    }

    ~Reactor() override {
        context_.TryCancel();
        release_main_hold();
        auto state = state_.lock();
        state.wait(changed_, [](const State& s) { return s.status.has_value(); });
    }

    void send(v1::ClientMessage message);
    void half_close();
    std::optional<ReceivedMessage> next(std::chrono::steady_clock::time_point deadline);
    std::optional<NetError> end();

    void OnReadDone(bool ok) override;
    void OnWriteDone(bool ok) override;
    void OnDone(const grpc::Status& status) override;

private:
    struct State {
        std::deque<ReceivedMessage> received;
        std::size_t received_bytes = 0;
        bool is_reading = true; ///< a read is in flight
        std::deque<v1::ClientMessage> unsent;
        bool is_writing = false; ///< a write is in flight
        bool wants_half_close = false;
        bool is_half_closed = false;
        bool is_open = true; ///< operations may start
        bool is_overrun = false;
        std::optional<grpc::Status> status; ///< set: the stream has ended
    };
    enum class NextOperation { kNone, kWrite, kHalfClose };

    NextOperation choose_operation(State& state);
    void start(NextOperation operation);
    void release_main_hold();
    void notify() const;

    ReadingOptions options_;
    grpc::ClientContext context_;
    std::unique_ptr<v1::LightField::Stub> stub_;
    v1::ServerMessage reading_; ///< gRPC's while `is_reading`
    v1::ClientMessage writing_; ///< gRPC's while `is_writing`
    std::condition_variable changed_;
    Guarded<State> state_;
};

/// Chooses the next operation, under the lock. `start` then starts it without the lock.
MessageStream::Reactor::NextOperation MessageStream::Reactor::choose_operation(State& state) {
    if (!state.is_open || state.is_writing || state.is_half_closed) {
        return NextOperation::kNone;
    }
    if (!state.unsent.empty()) {
        writing_ = std::move(state.unsent.front());
        state.unsent.pop_front();
        state.is_writing = true;
        AddHold();
        return NextOperation::kWrite;
    }
    if (state.wants_half_close) {
        state.is_half_closed = true;
        AddHold();
        return NextOperation::kHalfClose;
    }
    return NextOperation::kNone;
}

void MessageStream::Reactor::start(NextOperation operation) {
    switch (operation) {
    case NextOperation::kNone:
        return;
    case NextOperation::kWrite:
        StartWrite(&writing_);
        break;
    case NextOperation::kHalfClose:
        StartWritesDone();
        break;
    }
    RemoveHold();
}

void MessageStream::Reactor::release_main_hold() {
    if (std::exchange(state_.lock()->is_open, false)) {
        RemoveHold();
    }
}

void MessageStream::Reactor::send(v1::ClientMessage message) {
    NextOperation operation = NextOperation::kNone;
    {
        auto state = state_.lock();
        if (!state->is_open || state->wants_half_close) {
            return;
        }
        state->is_overrun = state->is_overrun || state->unsent.size() >= kMaxUnsent;
        if (!state->is_overrun) {
            state->unsent.push_back(std::move(message));
            operation = choose_operation(*state);
        }
    }
    if (operation == NextOperation::kNone && state_.lock()->is_overrun) {
        context_.TryCancel();
    }
    start(operation);
}

void MessageStream::Reactor::half_close() {
    NextOperation operation = NextOperation::kNone;
    {
        auto state = state_.lock();
        state->wants_half_close = true;
        operation = choose_operation(*state);
    }
    start(operation);
}

std::optional<ReceivedMessage> MessageStream::Reactor::next(std::chrono::steady_clock::time_point deadline) {
    std::optional<ReceivedMessage> message;
    bool resumes = false;
    {
        auto state = state_.lock();
        state.wait_until(changed_, deadline,
                         [](const State& s) { return !s.received.empty() || s.status.has_value(); });
        if (state->received.empty()) {
            return std::nullopt;
        }
        message = std::move(state->received.front());
        state->received.pop_front();
        state->received_bytes -= message->message.ByteSizeLong();
        resumes = state->is_open && !state->is_reading && state->received_bytes < options_.max_waiting_bytes;
        if (resumes) {
            state->is_reading = true;
            AddHold();
        }
    }
    if (resumes) {
        StartRead(&reading_);
        RemoveHold();
    }
    return message;
}

std::optional<NetError> MessageStream::Reactor::end() {
    auto state = state_.lock();
    if (!state->status || !state->received.empty()) {
        return std::nullopt;
    }
    if (state->is_overrun) {
        return NetError("stream: the server does not read our messages", true);
    }
    return state->status->ok() ? NetError("", true) : to_error("stream", *state->status);
}

void MessageStream::Reactor::OnReadDone(bool ok) {
    if (!ok) {
        release_main_hold();
        return;
    }
    bool continues = false;
    {
        auto state = state_.lock();
        state->received_bytes += reading_.ByteSizeLong();
        state->received.push_back({std::move(reading_), steady_now_ns()});
        continues = state->received_bytes < options_.max_waiting_bytes;
        state->is_reading = continues;
        reading_.Clear();
        changed_.notify_all();
        notify();
    }
    if (continues) {
        StartRead(&reading_);
    }
}

void MessageStream::Reactor::OnWriteDone(bool ok) {
    NextOperation operation = NextOperation::kNone;
    if (ok) {
        auto state = state_.lock();
        state->is_writing = false;
        operation = choose_operation(*state);
    }
    start(operation); // after a failed write the pending read fails too, and ends the stream
}

void MessageStream::Reactor::OnDone(const grpc::Status& status) {
    auto state = state_.lock();
    state->is_open = false;
    state->status = status;
    changed_.notify_all(); // under the lock: the destructor may be waiting, and destroys `changed_`
    notify();
}

void MessageStream::Reactor::notify() const {
    if (options_.on_change) {
        options_.on_change();
    }
}

MessageStream::MessageStream(const Connection& connection, ReadingOptions options)
    : max_bytes_per_second_(options.max_bytes_per_second),
      reactor_(std::make_unique<Reactor>(connection, std::move(options))) {}
MessageStream::~MessageStream() = default;

void MessageStream::send(v1::ClientMessage message) {
    reactor_->send(std::move(message));
}
void MessageStream::half_close() {
    reactor_->half_close();
}

std::optional<ReceivedMessage> MessageStream::next(std::chrono::steady_clock::time_point deadline) {
    using Clock = std::chrono::steady_clock;
    if (next_after_ > Clock::now()) {
        std::this_thread::sleep_until(std::min(deadline, next_after_));
        if (next_after_ > deadline) {
            return std::nullopt;
        }
    }
    auto message = reactor_->next(deadline);
    if (message && max_bytes_per_second_ > 0.0) {
        const std::chrono::duration<double> reading(static_cast<double>(message->message.ByteSizeLong()) /
                                                    max_bytes_per_second_);
        next_after_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(reading);
    }
    return message;
}

std::optional<NetError> MessageStream::end() const {
    return reactor_->end();
}

} // namespace fieldcast::client::net
