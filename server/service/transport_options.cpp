// SPDX-License-Identifier: Apache-2.0
#include "server/service/transport_options.h"

#include <grpcpp/resource_quota.h>

namespace fieldcast::service {

namespace {

using std::chrono::milliseconds;

constexpr int kMaxStreamsPerConnection = 64;
constexpr std::size_t kTransportMemoryBytes = 256U << 20; // gRPC's memory for reading and for calls
constexpr int kMaxTransportThreads = 64;
constexpr int kMaxHeaderBytes = 8 << 10;   // of one call; our own headers have a few hundred bytes, tokens included
constexpr int kMaxFrameBytes = 16 << 10;   // the smallest value that HTTP/2 allows
constexpr int kHeaderTableBytes = 4 << 10; // per connection, HTTP/2's default

} // namespace

void set_transport_options(grpc::ServerBuilder& builder, const session::Limits& limits) {
    const auto ms = [](milliseconds duration) { return static_cast<int>(duration.count()); };
    builder.SetMaxReceiveMessageSize(session::kMaxClientMessageBytes);
    builder.SetResourceQuota(
        grpc::ResourceQuota("fieldcast-server").Resize(kTransportMemoryBytes).SetMaxThreads(kMaxTransportThreads));
    builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, kMaxStreamsPerConnection);
    builder.AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE, kMaxHeaderBytes);
    builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_FRAME_SIZE, kMaxFrameBytes);
    builder.AddChannelArgument(GRPC_ARG_HTTP2_HPACK_TABLE_SIZE_DECODER, kHeaderTableBytes);
    builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, ms(limits.keepalive_interval));
    builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, ms(limits.keepalive_timeout));
    builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
    builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, ms(limits.handshake_deadline));
    builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_IDLE_MS, ms(limits.idle_deadline));
    builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
    builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, 5'000);
}

} // namespace fieldcast::service
