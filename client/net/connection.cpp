// SPDX-License-Identifier: Apache-2.0
#include "client/net/connection.h"

#include "client/net/connection_state.h"
#include "core/base/error.h"
#include "core/base/host_port.h"
#include "core/base/log.h"
#include "core/wire/protobuf_log.h"

#include <grpc/support/log.h>
#include <mutex>

namespace fieldcast::client::net {
namespace {

// Chunks are at most 2 MiB. The cap bounds the memory of one message and leaves room for servers with larger chunks.
constexpr int kMaxMessageBytes = 64 << 20;
constexpr int kKeepaliveTimeMs = 20'000;
constexpr int kKeepaliveTimeoutMs = 10'000;
constexpr int kDialBackoffMs = 200;

grpc::ChannelArguments channel_arguments(const Access& access) {
    grpc::ChannelArguments arguments;
    arguments.SetMaxReceiveMessageSize(kMaxMessageBytes);
    arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, kKeepaliveTimeMs);
    arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, kKeepaliveTimeoutMs);
    arguments.SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
    // Otherwise all connections of the process share sockets and gRPC's own delays between attempts.
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, kDialBackoffMs);
    if (!access.tls_name.empty()) {
        arguments.SetSslTargetNameOverride(access.tls_name);
    }
    return arguments;
}

std::shared_ptr<grpc::ChannelCredentials> credentials(const Access& access) {
    if (!access.uses_tls) {
        return grpc::InsecureChannelCredentials();
    }
    grpc::SslCredentialsOptions options;
    if (!access.tls_ca.empty()) {
        options.pem_root_certs = read_pem(access.tls_ca);
    }
    if (!access.tls_certificate.empty()) {
        options.pem_cert_chain = read_pem(access.tls_certificate);
        options.pem_private_key = read_pem(access.tls_key);
    }
    return grpc::SslCredentials(options);
}

/// The token of `access`. Throws UserError if it would leave this machine unencrypted.
std::string sendable_token(const std::string& address, const Access& access) {
    std::string token = read_token(access);
    const auto dialled = parse_host_port(address);
    const bool stays_here = address.starts_with("unix:") || (dialled && is_loopback(dialled->host));
    if (!token.empty() && !access.uses_tls && !stays_here) {
        throw UserError("the token would travel to " + address + " unencrypted; use --tls, or --server https://" +
                        address);
    }
    return token;
}

/// Redirects gRPC's own log to ours, at level debug. It only adds details to failures, which calls report as a status.
void log_transport() {
    static std::once_flag once;
    std::call_once(once, [] {
        gpr_set_log_function([](gpr_log_func_args* line) { log::debug("transport", {{"message", line->message}}); });
    });
}

} // namespace

Connection::Connection(const std::string& address, const Access& access)
    : state_(std::make_unique<ConnectionState>(
          ConnectionState{.channel = grpc::CreateCustomChannel(address, credentials(access), channel_arguments(access)),
                          .token = sendable_token(address, access)})) {
    log_transport();
    wire::take_protobuf_log();
}

Connection::~Connection() = default;

} // namespace fieldcast::client::net
