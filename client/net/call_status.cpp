// SPDX-License-Identifier: Apache-2.0
#include "client/net/call_status.h"

#include "core/base/printable.h"

namespace fieldcast::client::net {
namespace {

/// Adds to gRPC's message, which describes the transport, what the user should check.
std::string with_advice(const std::string& message) {
    const auto says = [&](const char* words) { return message.find(words) != std::string::npos; };
    if (says("andshak")) {
        return message + " (does the server use TLS, does --tls-ca name the authority that signed its certificate, "
                         "does it require --tls-cert?)";
    }
    if (says("Socket closed")) {
        return message + " (does the server require --tls, or a certificate from --tls-cert?)";
    }
    return says("not in peer certificate") ? message + " (set --tls-name to a name in the certificate)" : message;
}

} // namespace

NetError to_error(const std::string& what, const grpc::Status& status) {
    const std::string said = printable(status.error_message()); // by any program that answers at this address
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
