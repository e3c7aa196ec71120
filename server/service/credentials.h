// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/access/access_watch.h"

#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_context.h>
#include <memory>

namespace fieldcast::service {

/// TLS, or plain text that never leaves this machine. With tokens, every call of every service passes `gate` first;
/// `gate` must outlive the server. Certificates are read again when their files change.
std::shared_ptr<grpc::ServerCredentials> make_credentials(const access::Security& security, const access::Gate& gate);

/// Whose call it is. The call has passed the gate, but its token may have been revoked since.
tl::expected<access::Identity, access::Denial> identify(const grpc::CallbackServerContext& context,
                                                        const access::Gate& gate);

} // namespace fieldcast::service
