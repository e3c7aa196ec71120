// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/wire/chunks.h"

#include "fieldcast/v1/light_field.pb.h"

#include <grpcpp/support/byte_buffer.h>
#include <optional>
#include <string>

namespace fieldcast::service {

/// The bytes of one message. `head` is copied. The payload is not: the buffer keeps its owner alive, so all clients
/// share one encoded strip.
grpc::ByteBuffer to_buffer(const wire::WireChunk& chunk);

/// Parses a message from a client. Empty if the bytes are not a ClientMessage.
std::optional<v1::ClientMessage> parse_client_message(const grpc::ByteBuffer& bytes);

/// The part of an address that all sessions of one peer share: "ipv4:127.0.0.1:50123" -> "ipv4:127.0.0.1".
std::string peer_host(const std::string& peer);

} // namespace fieldcast::service
