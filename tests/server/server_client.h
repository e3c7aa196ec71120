// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fieldcast/v1/catalog.grpc.pb.h"
#include "fieldcast/v1/light_field.grpc.pb.h"

#include <functional>
#include <grpcpp/grpcpp.h>
#include <memory>
#include <optional>
#include <string>

namespace fieldcast::test {

/// No call of a test takes longer; beyond, it fails instead of hanging.
inline constexpr std::chrono::seconds kCallDeadline{60};

/// In plain text, or with `credentials`.
std::shared_ptr<grpc::Channel>
connect(int port, const std::shared_ptr<grpc::ChannelCredentials>& credentials = grpc::InsecureChannelCredentials());

/// In plain text, and its transport takes in no more than 64 KiB that nobody has read: otherwise gRPC lets megabytes in
/// over a fast connection.
std::shared_ptr<grpc::Channel> connect_with_small_window(int port);

/// A client of LightField.Open that shows every message.
class OpenCall {
public:
    explicit OpenCall(const std::shared_ptr<grpc::Channel>& channel, const std::string& token = "",
                      std::chrono::seconds deadline = kCallDeadline);

    bool send(const v1::ClientMessage& message) { return stream_->Write(message); }
    bool configure(const v1::Configure& wanted = {});
    bool acknowledge(const v1::FrameChunk& chunk);

    /// The next message; empty at the end of the stream.
    std::optional<v1::ServerMessage> read();

    /// The next message of that kind; empty if the stream ends before.
    std::optional<v1::ServerMessage> read_until(v1::ServerMessage::MessageCase kind);

    /// Reads to the end of the next frame: its trailer; empty if the stream ends before.
    std::optional<v1::FrameChunk> read_frame();

    void half_close() { stream_->WritesDone(); }
    void cancel() { context_.TryCancel(); }

    /// Reads what is left.
    grpc::Status finish();

private:
    grpc::ClientContext context_;
    std::unique_ptr<v1::LightField::Stub> stub_;
    std::unique_ptr<grpc::ClientReaderWriter<v1::ClientMessage, v1::ServerMessage>> stream_;
};

/// A unary call on raw bytes.
grpc::Status call_raw(grpc::Channel& channel, const char* method, const std::string& request, std::string& response,
                      const std::string& token = "");

/// Sends one message of any bytes on a bidirectional call, and reads one answer if there is one.
grpc::Status exchange_raw(grpc::Channel& channel, const char* method, const std::string& request, std::string& response,
                          const std::string& token = "");

} // namespace fieldcast::test
