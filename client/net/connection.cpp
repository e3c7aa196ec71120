// SPDX-License-Identifier: Apache-2.0
#include "client/net/connection.h"
#include "client/net/connection_state.h"

#include "core/base/error.h"
#include "core/base/host_port.h"
#include "core/base/log.h"
#include "core/base/printable.h"
#include "core/wire/protobuf_log.h"

#include <grpc/support/log.h>
#include <mutex>

namespace fieldcast::client::net {
namespace {

// Chunks are at most 2 MiB; the cap leaves room for servers with larger ones and bounds what one message can cost.
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
    // Otherwise all connections of the process share sockets and gRPC's own waiting times between attempts.
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

/// A token is sent encrypted, or not beyond this machine.
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

/// gRPC says what the transport saw; people want to know what to look at.
std::string with_advice(const std::string& message) {
    const auto says = [&](const char* words) { return message.find(words) != std::string::npos; };
    if (says("andshak")) {
        return message + " (does it speak TLS, does --tls-ca name the authority that signed its certificate, does it "
                         "ask for --tls-cert?)";
    }
    if (says("Socket closed")) {
        return message + " (does the server want --tls, or a certificate from --tls-cert?)";
    }
    return says("not in peer certificate") ? message + " (name one that is with --tls-name)" : message;
}

/// Failures reach us as a status; what gRPC says besides is for those who look into the details.
void log_transport() {
    static std::once_flag once;
    std::call_once(once, [] {
        gpr_set_log_function([](gpr_log_func_args* line) { log::debug("transport", {{"message", line->message}}); });
    });
}

} // namespace

Connection::Connection(const std::string& address, const Access& access)
    : state_(std::make_unique<State>(
          State{.channel = grpc::CreateCustomChannel(address, credentials(access), channel_arguments(access)),
                .token = sendable_token(address, access)})) {
    log_transport();
    wire::take_protobuf_log();
}

Connection::~Connection() = default;

void Connection::State::prepare(grpc::ClientContext& context) const {
    if (!token.empty()) {
        context.AddMetadata("authorization", "Bearer " + token);
    }
}

NetError to_error(const std::string& what, const grpc::Status& status) {
    const std::string said = printable(status.error_message()); // by the server, or by whatever stands in its place
    switch (status.error_code()) {
    case grpc::StatusCode::UNAVAILABLE:
        return {what + ": " + with_advice(said), true, false, Obstacle::kUnreachable};
    case grpc::StatusCode::DEADLINE_EXCEEDED:
    case grpc::StatusCode::RESOURCE_EXHAUSTED:
    case grpc::StatusCode::ABORTED:
    case grpc::StatusCode::CANCELLED:
    case grpc::StatusCode::UNKNOWN:
    case grpc::StatusCode::INTERNAL:
        return {what + ": " + with_advice(said), true};
    case grpc::StatusCode::UNAUTHENTICATED:
    case grpc::StatusCode::PERMISSION_DENIED:
        return {what + ": " + said, false, true};
    default:
        return {what + ": " + said, false};
    }
}

} // namespace fieldcast::client::net
