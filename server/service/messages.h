// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/wire/chunks.h"

#include "fieldcast/v1/light_field.pb.h"

#include <grpcpp/support/byte_buffer.h>
#include <optional>
#include <string>

namespace fieldcast::service {

/// The bytes of one message. `head` is copied; the payload is not: the buffer keeps its owner alive, so that one
/// encoded strip serves any number of clients.
grpc::ByteBuffer to_buffer(const wire::WireChunk& chunk);

/// Reads a message from outside. Empty if the bytes are not a ClientMessage.
std::optional<v1::ClientMessage> parse_client_message(const grpc::ByteBuffer& bytes);

/// "ipv4:127.0.0.1:50123" -> "ipv4:127.0.0.1": what sessions of one peer have in common.
std::string peer_host(const std::string& peer);

} // namespace fieldcast::service
