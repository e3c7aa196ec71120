// SPDX-License-Identifier: Apache-2.0
#include "server/service/messages.h"

#include <array>
#include <grpcpp/impl/codegen/proto_utils.h>
#include <grpcpp/support/slice.h>

namespace fieldcast::service {

namespace {

void release_owner(void* owner) {
    delete static_cast<wire::SharedBytes*>(owner);
}

/// A slice that shares the payload.
grpc::Slice share(const wire::WireChunk& chunk) {
    // gRPC takes a mutable pointer but never writes to a slice that it sends.
    auto* const bytes = const_cast<std::byte*>(chunk.payload.data());
    return {bytes, chunk.payload.size(), release_owner, new wire::SharedBytes(chunk.owner)};
}

} // namespace

grpc::ByteBuffer to_buffer(const wire::WireChunk& chunk) {
    const grpc::Slice head(chunk.head);
    if (chunk.payload.empty()) {
        return {&head, 1};
    }
    const std::array slices{head, share(chunk)};
    return {slices.data(), slices.size()};
}

std::optional<v1::ClientMessage> parse_client_message(const grpc::ByteBuffer& bytes) {
    v1::ClientMessage message;
    grpc::ByteBuffer shared(bytes); // Deserialize empties its argument
    const grpc::Status status = grpc::SerializationTraits<v1::ClientMessage>::Deserialize(&shared, &message);
    return status.ok() ? std::optional(std::move(message)) : std::nullopt;
}

std::string peer_host(const std::string& peer) {
    return peer.substr(0, peer.rfind(':'));
}

} // namespace fieldcast::service
