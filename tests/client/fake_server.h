// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "core/wire/frame_assembler.h"

#include "fieldcast/v1/light_field.grpc.pb.h"

#include <atomic>
#include <condition_variable>
#include <functional>
#include <grpcpp/grpcpp.h>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fieldcast::test {

/// The server's end of one stream, for a script to play.
class FakeCall {
public:
    using Stream = grpc::ServerReaderWriter<v1::ServerMessage, v1::ClientMessage>;
    explicit FakeCall(Stream& stream) : stream_(stream) {}

    /// The next message of that kind, others are skipped; nothing when the client has half-closed.
    std::optional<v1::ClientMessage> read_until(v1::ClientMessage::MessageCase kind);
    bool send(const v1::ServerMessage& message) { return stream_.Write(message); }
    void send(const std::vector<v1::ServerMessage>& messages);
    /// Waits for the client's half-close.
    void read_rest();

    /// Reads Configure and grants it. Returns the views that were granted.
    wire::ViewSet grant();

private:
    Stream& stream_;
};

/// A server whose streams follow a script: for what the real one never does.
class FakeServer final : public v1::LightField::Service {
public:
    /// `call` is the number of the stream, from 0. The stream ends with OK when the script returns.
    using Script = std::function<void(FakeCall& stream, int call)>;

    explicit FakeServer(Script script);
    ~FakeServer() override;

    std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
    int call_count() const { return calls_; }

    grpc::Status Open(grpc::ServerContext* context, FakeCall::Stream* stream) override;

private:
    Script script_;
    std::atomic<int> calls_ = 0;
    int port_ = 0;
    std::unique_ptr<grpc::Server> server_;
};

/// The answer that grants what `configure` asks for, with views of 64×36 pixels unless it says. Its epoch is the number
/// of the request.
v1::ServerMessage configured_message(const v1::Configure& configure);

/// All messages of a frame of views whose pixels depend on its id.
std::vector<v1::ServerMessage> views_messages(const wire::ViewSet& set, std::uint64_t frame_id,
                                              std::uint32_t epoch = 1);

/// The grey of every pixel of `views_messages`.
std::uint8_t fake_grey(std::uint64_t frame_id);

} // namespace fieldcast::test
