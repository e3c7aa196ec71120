// SPDX-License-Identifier: Apache-2.0
#include "client/net/connection.h"
#include "client/net/connection_state.h"

namespace fieldcast::client::net {
namespace {

// Chunks are at most 2 MiB; the cap leaves room for servers with larger ones and bounds what one message can cost.
constexpr int kMaxMessageBytes = 64 << 20;
constexpr int kKeepaliveTimeMs = 20'000;
constexpr int kKeepaliveTimeoutMs = 10'000;
constexpr int kDialBackoffMs = 200;

grpc::ChannelArguments channel_arguments() {
    grpc::ChannelArguments arguments;
    arguments.SetMaxReceiveMessageSize(kMaxMessageBytes);
    arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, kKeepaliveTimeMs);
    arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, kKeepaliveTimeoutMs);
    arguments.SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
    // Otherwise all connections of the process share sockets and gRPC's own waiting times between attempts.
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, kDialBackoffMs);
    return arguments;
}

} // namespace

Connection::Connection(const std::string& address)
    : state_(std::make_unique<State>(
          State{grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), channel_arguments())})) {}

Connection::~Connection() = default;

NetError to_error(const std::string& what, const grpc::Status& status) {
    switch (status.error_code()) {
    case grpc::StatusCode::UNAVAILABLE:
    case grpc::StatusCode::DEADLINE_EXCEEDED:
    case grpc::StatusCode::RESOURCE_EXHAUSTED:
    case grpc::StatusCode::ABORTED:
    case grpc::StatusCode::CANCELLED:
    case grpc::StatusCode::UNKNOWN:
    case grpc::StatusCode::INTERNAL:
        return {what + ": " + status.error_message(), true};
    default:
        return {what + ": " + status.error_message(), false};
    }
}

} // namespace fieldcast::client::net
