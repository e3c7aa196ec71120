// SPDX-License-Identifier: Apache-2.0
#include "bench/fanout/bare_server.h"

#include "core/base/guarded.h"

#include <condition_variable>
#include <grpcpp/generic/async_generic_service.h>
#include <grpcpp/grpcpp.h>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

namespace fieldcast::bench::fanout {

namespace {

using Clock = std::chrono::steady_clock;
using SlicedFrame = std::vector<grpc::Slice>;

class Stream;

/// The open streams.
class Streams {
public:
    void add(Stream* stream) { streams_.lock()->insert(stream); }
    void remove(Stream* stream) { streams_.lock()->erase(stream); }
    void begin(const SlicedFrame& frame);

private:
    Guarded<std::set<Stream*>> streams_;
};

/// One client with at most one write in flight.
class Stream final : public grpc::ServerGenericBidiReactor {
public:
    explicit Stream(Streams& all) : all_(all) {
        all_.add(this);
        StartRead(&incoming_); // the client ends the call
    }

    /// Called by the pacing thread.
    void begin(const SlicedFrame& frame) {
        {
            auto sending = sending_.lock();
            if (sending->frame != nullptr || sending->is_over) {
                return;
            }
            sending->frame = &frame;
            sending->next = 0;
        }
        write_next();
    }

    void OnReadDone(bool ok) override {
        if (ok) {
            incoming_.Clear();
            return StartRead(&incoming_);
        }
        sending_.lock()->is_over = true;
        finish_if_idle();
    }

    void OnWriteDone(bool ok) override {
        outgoing_.Clear();
        if (ok) {
            write_next();
        } else {
            leave_frame();
        }
    }

    void OnDone() override {
        all_.remove(this);
        delete this;
    }

private:
    struct Sending {
        const SlicedFrame* frame = nullptr; ///< null: no write is in flight
        std::size_t next = 0;
        bool is_over = false; ///< the client has ended the call
        bool is_finished = false;
    };

    void write_next() {
        bool has_more = false;
        {
            auto sending = sending_.lock();
            has_more = !sending->is_over && sending->next < sending->frame->size();
            if (has_more) {
                outgoing_ = grpc::ByteBuffer(&(*sending->frame)[sending->next++], 1);
            }
        }
        has_more ? StartWrite(&outgoing_) : leave_frame();
    }

    void leave_frame() {
        sending_.lock()->frame = nullptr;
        finish_if_idle();
    }

    void finish_if_idle() {
        auto sending = sending_.lock();
        if (sending->is_over && sending->frame == nullptr && !std::exchange(sending->is_finished, true)) {
            Finish(grpc::Status::OK);
        }
    }

    Streams& all_;
    grpc::ByteBuffer incoming_;
    grpc::ByteBuffer outgoing_;
    Guarded<Sending> sending_;
};

void Streams::begin(const SlicedFrame& frame) {
    auto streams = streams_.lock(); // so that none of them is deleted in the meantime
    for (Stream* stream : *streams) {
        stream->begin(frame);
    }
}

class Service final : public grpc::CallbackGenericService {
public:
    explicit Service(Streams& streams) : streams_(streams) {}
    grpc::ServerGenericBidiReactor* CreateReactor(grpc::GenericCallbackServerContext*) override {
        return new Stream(streams_); // deletes itself
    }

private:
    Streams& streams_;
};

} // namespace

struct BareServer::State {
    std::vector<SlicedFrame> frames;
    Streams streams;
    Service service{streams};
    int port = 0;
    std::unique_ptr<grpc::Server> server;
    std::jthread pacer;

    void pace(const std::stop_token& stop, Clock::duration interval) {
        std::mutex mutex;
        std::condition_variable_any never;
        std::unique_lock lock(mutex);
        auto due = Clock::now();
        for (std::size_t i = 0; !stop.stop_requested(); i = (i + 1) % frames.size()) {
            streams.begin(frames[i]);
            due = std::max(due + interval, Clock::now());
            never.wait_until(lock, stop, due, [] { return false; });
        }
    }
};

BareServer::BareServer(const MessageLoop& loop, double frames_per_second) : state_(std::make_unique<State>()) {
    for (const MessageLoop::Frame& frame : loop.frames) {
        state_->frames.emplace_back(frame.begin(), frame.end());
    }
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &state_->port);
    builder.RegisterCallbackGenericService(&state_->service);
    state_->server = builder.BuildAndStart();
    if (state_->server == nullptr || state_->port == 0) {
        throw std::runtime_error("cannot listen on 127.0.0.1");
    }
    const auto interval =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / frames_per_second));
    state_->pacer =
        std::jthread([&state = *state_, interval](const std::stop_token& stop) { state.pace(stop, interval); });
}

BareServer::~BareServer() {
    state_->pacer = {}; // stops and joins
    state_->server->Shutdown(std::chrono::system_clock::now());
    state_->server->Wait();
}

int BareServer::port() const {
    return state_->port;
}

} // namespace fieldcast::bench::fanout
