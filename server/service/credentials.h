// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/access/access_watch.h"
#include "server/service/service_metrics.h"

#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_context.h>
#include <memory>

namespace fieldcast::service {

/// TLS, or plain text on loopback only. With tokens, every call of every service passes `gate` first. `gate` and
/// `metrics` must outlive the server. Certificates are read again when their files change.
std::shared_ptr<grpc::ServerCredentials> make_credentials(const access::Security& security, const access::Gate& gate,
                                                          ServiceMetrics& metrics);

/// The caller's identity. The call has passed the gate before, but its token may have been revoked since.
tl::expected<access::Identity, access::Denial> identify(const grpc::CallbackServerContext& context,
                                                        const access::Gate& gate);

} // namespace fieldcast::service
