// SPDX-License-Identifier: Apache-2.0
#include "bench/fanout/receivers.h"

#include "core/base/guarded.h"
#include "core/wire/convert.h"

#include "fieldcast/v1/light_field.pb.h"

#include <algorithm>
#include <atomic>
#include <deque>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>
#include <stdexcept>
#include <thread>

namespace fieldcast::bench::fanout {

namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kMethod = "/fieldcast.v1.LightField/Open";
constexpr std::size_t kSmallBytes = 4096; ///< trailers and answers are smaller; few payloads are, and may be parsed
constexpr std::chrono::milliseconds kLookInterval{5};

grpc::ByteBuffer to_buffer(const v1::ClientMessage& message) {
    const grpc::Slice slice(message.SerializeAsString());
    return {&slice, 1};
}

std::string text_of(const grpc::ByteBuffer& buffer) {
    std::vector<grpc::Slice> slices;
    std::string text;
    if (buffer.Dump(&slices).ok()) {
        for (const grpc::Slice& slice : slices) {
            text.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
        }
    }
    return text;
}

/// A request for any planes or views in any codec.
v1::ClientMessage what_there_is() {
    v1::ClientMessage message;
    v1::Configure& wanted = *message.mutable_configure();
    wanted.set_request_id(1);
    for (const DeliveryMode mode : kAll<DeliveryMode>) {
        wanted.add_modes(wire::to_proto(mode));
    }
    for (const PlaneSemantic semantic : kAll<PlaneSemantic>) {
        if (!is_picture(semantic)) {
            continue;
        }
        v1::CodecPreference& preference = *wanted.add_codecs();
        preference.set_semantic(wire::to_proto(semantic));
        preference.add_codecs(v1::CODEC_ZSTD_FILTERED); // for channels that encode on request
        for (const Codec codec : kAll<Codec>) {
            preference.add_codecs(wire::to_proto(codec));
        }
    }
    return message;
}

std::shared_ptr<grpc::Channel> connect(int port) {
    grpc::ChannelArguments arguments;
    arguments.SetMaxReceiveMessageSize(-1);
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1); // otherwise all clients share one connection
    const std::string address = "127.0.0.1:" + std::to_string(port);
    return grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments);
}

/// One client. Reactions run in gRPC's threads, a read's and a write's at the same time.
class Receiver final : public grpc::ClientBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer> {
public:
    explicit Receiver(int port) : stub_(connect(port)), outgoing_(to_buffer(what_there_is())) {
        stub_.PrepareBidiStreamingCall(&context_, kMethod, {}, this);
        StartWrite(&outgoing_);
        StartRead(&incoming_);
        StartCall();
    }

    void cancel() { context_.TryCancel(); }

    void OnReadDone(bool ok) override {
        if (!ok) {
            return;
        }
        bytes_ += incoming_.Length();
        if (is_capturing_) {
            capture(text_of(incoming_));
        }
        if (incoming_.Length() <= kSmallBytes) {
            handle(text_of(incoming_));
        }
        incoming_.Clear();
        StartRead(&incoming_);
    }

    void OnWriteDone(bool ok) override {
        v1::ClientMessage ack;
        {
            auto writing = writing_.lock();
            if (!ok || writing->waiting.empty()) {
                writing->is_busy = !ok;
                return;
            }
            ack = std::move(writing->waiting.front());
            writing->waiting.pop_front();
        }
        outgoing_ = to_buffer(ack);
        StartWrite(&outgoing_);
    }

    void OnDone(const grpc::Status& status) override {
        auto end = end_.lock();
        end->is_done = true;
        if (end->problem.empty()) {
            end->problem = status.error_message();
        }
    }

    std::uint64_t bytes() const { return bytes_; }
    std::uint64_t frames() const { return frames_; }
    bool is_done() { return end_.lock()->is_done; }
    std::string problem() { return end_.lock()->problem; }

    void begin_capture() { is_capturing_ = true; }
    std::size_t captured() { return captured_.lock()->frames.size(); }
    MessageLoop take_captured() {
        is_capturing_ = false;
        return std::move(*captured_.lock());
    }

private:
    struct Writing {
        bool is_busy = true; ///< the first message is being written
        std::deque<v1::ClientMessage> waiting;
    };
    struct End {
        bool is_done = false;
        std::string problem; ///< the server's error
    };

    void handle(const std::string& bytes) {
        v1::ServerMessage message;
        if (!message.ParseFromString(bytes)) {
            return;
        }
        if (message.has_refused()) {
            end_.lock()->problem = message.refused().message();
        }
        if (message.frame_chunk().has_trailer()) {
            ++frames_;
            acknowledge(message.frame_chunk());
        }
    }

    void acknowledge(const v1::FrameChunk& trailer) {
        v1::ClientMessage message;
        v1::FrameAck& ack = *message.mutable_frame_ack();
        ack.set_frame_id(trailer.frame_id());
        ack.set_epoch(trailer.epoch());
        ack.set_outcome(v1::FRAME_OUTCOME_DECODED);
        {
            auto writing = writing_.lock();
            if (writing->is_busy) {
                writing->waiting.push_back(std::move(message));
                return;
            }
            writing->is_busy = true;
        }
        outgoing_ = to_buffer(message);
        StartWrite(&outgoing_);
    }

    /// Keeps frames from the next header on: an index of 0.
    void capture(const std::string& bytes) {
        v1::ServerMessage message;
        if (!message.ParseFromString(bytes) || !message.has_frame_chunk()) {
            return;
        }
        current_ = message.frame_chunk().has_header() ? MessageLoop::Frame() : std::move(current_);
        current_.push_back(bytes);
        v1::ServerMessage first;
        if (message.frame_chunk().has_trailer() && first.ParseFromString(current_.front()) &&
            first.frame_chunk().has_header()) {
            captured_.lock()->frames.push_back(std::exchange(current_, {}));
        }
    }

    grpc::GenericStub stub_;
    grpc::ClientContext context_;
    grpc::ByteBuffer incoming_; ///< belongs to the read in flight
    grpc::ByteBuffer outgoing_; ///< belongs to the write in flight
    std::atomic<std::uint64_t> bytes_ = 0;
    std::atomic<std::uint64_t> frames_ = 0;
    std::atomic<bool> is_capturing_ = false;
    MessageLoop::Frame current_; ///< of the reading reaction
    Guarded<MessageLoop> captured_;
    Guarded<Writing> writing_;
    Guarded<End> end_;
};

/// Polls a condition, because the counts of gRPC's threads have no event.
template <class Condition> bool becomes_true(const Condition& condition, std::chrono::seconds patience) {
    const auto deadline = Clock::now() + patience;
    while (!condition()) {
        if (Clock::now() >= deadline) {
            return false;
        }
        std::this_thread::sleep_for(kLookInterval);
    }
    return true;
}

} // namespace

struct Receivers::State {
    std::deque<Receiver> clients;

    /// Throws if the server refuses to send frames to one of them.
    void check() {
        for (Receiver& client : clients) {
            if (const std::string problem = client.problem(); client.is_done() || !problem.empty()) {
                throw std::runtime_error("a client receives no frames: " + problem);
            }
        }
    }
};

Receivers::Receivers(int port, std::size_t count) : state_(std::make_unique<State>()) {
    while (state_->clients.size() < count) {
        state_->clients.emplace_back(port);
    }
}

Receivers::~Receivers() {
    for (Receiver& client : state_->clients) {
        client.cancel();
    }
    for (Receiver& client : state_->clients) {
        while (!client.is_done()) { // gRPC still refers to it
            std::this_thread::sleep_for(kLookInterval);
        }
    }
}

void Receivers::wait_for_frames(std::uint64_t count, std::chrono::seconds patience) {
    const auto have_come = [&] {
        state_->check();
        return std::ranges::all_of(state_->clients, [&](const Receiver& client) { return client.frames() >= count; });
    };
    if (!becomes_true(have_come, patience)) {
        throw std::runtime_error("a client received no frames in " + std::to_string(patience.count()) + " s");
    }
}

std::uint64_t Receivers::bytes() const {
    std::uint64_t sum = 0;
    for (const Receiver& client : state_->clients) {
        sum += client.bytes();
    }
    return sum;
}

std::uint64_t Receivers::frames() const {
    std::uint64_t sum = 0;
    for (const Receiver& client : state_->clients) {
        sum += client.frames();
    }
    return sum;
}

MessageLoop Receivers::capture(std::size_t count, std::chrono::seconds patience) {
    Receiver& client = state_->clients.front();
    client.begin_capture();
    const auto is_complete = [&] {
        state_->check();
        return client.captured() >= count;
    };
    if (!becomes_true(is_complete, patience)) {
        throw std::runtime_error("no frames of the recording arrive");
    }
    return client.take_captured();
}

} // namespace fieldcast::bench::fanout
