// SPDX-License-Identifier: Apache-2.0
#include "tests/server/server_client.h"

#include <grpcpp/impl/codegen/client_unary_call.h>

namespace fieldcast::test {

namespace {

grpc::ByteBuffer to_buffer(const std::string& bytes) {
    const grpc::Slice slice(bytes);
    return {&slice, 1};
}

std::string to_string(const grpc::ByteBuffer& buffer) {
    grpc::Slice slice;
    return buffer.DumpToSingleSlice(&slice).ok()
               ? std::string(reinterpret_cast<const char*>(slice.begin()), slice.size())
               : std::string();
}

/// Waits for the connection: gRPC 1.51 reads errno of `connect` after calls that may have changed it, so that now and
/// then a connection that is merely under way counts as failed at first. Users' clients dial again.
void prepare(grpc::ClientContext& context, const std::string& token, std::chrono::seconds deadline = kCallDeadline) {
    context.set_wait_for_ready(true);
    context.set_deadline(std::chrono::system_clock::now() + deadline);
    if (!token.empty()) {
        context.AddMetadata("authorization", "Bearer " + token);
    }
}

} // namespace

std::shared_ptr<grpc::Channel> connect(int port, const std::shared_ptr<grpc::ChannelCredentials>& credentials) {
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1); // a connection of its own
    return grpc::CreateCustomChannel("127.0.0.1:" + std::to_string(port), credentials, arguments);
}

std::shared_ptr<grpc::Channel> connect_with_small_window(int port) {
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
    arguments.SetInt(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, 64 << 10);
    return grpc::CreateCustomChannel("127.0.0.1:" + std::to_string(port), grpc::InsecureChannelCredentials(),
                                     arguments);
}

OpenCall::OpenCall(const std::shared_ptr<grpc::Channel>& channel, const std::string& token,
                   std::chrono::seconds deadline)
    : stub_(v1::LightField::NewStub(channel)) {
    prepare(context_, token, deadline);
    stream_ = stub_->Open(&context_);
}

bool OpenCall::configure(const v1::Configure& wanted) {
    v1::ClientMessage message;
    *message.mutable_configure() = wanted;
    return send(message);
}

bool OpenCall::acknowledge(const v1::FrameChunk& chunk) {
    v1::ClientMessage message;
    v1::FrameAck& ack = *message.mutable_frame_ack();
    ack.set_frame_id(chunk.frame_id());
    ack.set_epoch(chunk.epoch());
    ack.set_outcome(v1::FRAME_OUTCOME_DECODED);
    return send(message);
}

std::optional<v1::ServerMessage> OpenCall::read() {
    v1::ServerMessage message;
    return stream_->Read(&message) ? std::optional(std::move(message)) : std::nullopt;
}

std::optional<v1::ServerMessage> OpenCall::read_until(v1::ServerMessage::MessageCase kind) {
    auto message = read();
    while (message && message->message_case() != kind) {
        message = read();
    }
    return message;
}

std::optional<v1::FrameChunk> OpenCall::read_frame() {
    auto message = read_until(v1::ServerMessage::kFrameChunk);
    while (message && !message->frame_chunk().has_trailer()) {
        message = read_until(v1::ServerMessage::kFrameChunk);
    }
    return message ? std::optional(message->frame_chunk()) : std::nullopt;
}

grpc::Status OpenCall::finish() {
    while (read()) {
    }
    return stream_->Finish();
}

grpc::Status call_raw(grpc::Channel& channel, const char* method, const std::string& request, std::string& response,
                      const std::string& token) {
    grpc::ClientContext context;
    prepare(context, token);
    grpc::ByteBuffer answer;
    const grpc::internal::RpcMethod rpc(method, grpc::internal::RpcMethod::NORMAL_RPC);
    const grpc::Status status = grpc::internal::BlockingUnaryCall<grpc::ByteBuffer, grpc::ByteBuffer>(
        &channel, rpc, &context, to_buffer(request), &answer);
    response = to_string(answer);
    return status;
}

grpc::Status exchange_raw(grpc::Channel& channel, const char* method, const std::string& request, std::string& response,
                          const std::string& token) {
    grpc::ClientContext context;
    prepare(context, token);
    const grpc::internal::RpcMethod rpc(method, grpc::internal::RpcMethod::BIDI_STREAMING);
    using Factory = grpc::internal::ClientReaderWriterFactory<grpc::ByteBuffer, grpc::ByteBuffer>;
    const std::unique_ptr<grpc::ClientReaderWriter<grpc::ByteBuffer, grpc::ByteBuffer>> stream(
        Factory::Create(&channel, rpc, &context));
    stream->Write(to_buffer(request));
    grpc::ByteBuffer answer;
    if (stream->Read(&answer)) {
        response = to_string(answer);
    }
    stream->WritesDone();
    while (stream->Read(&answer)) {
    }
    return stream->Finish();
}

} // namespace fieldcast::test
