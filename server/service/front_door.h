// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/host_port.h"
#include "server/access/access_watch.h"
#include "server/listener/acceptor.h"
#include "server/listener/self_probe.h"
#include "server/metrics/registry.h"
#include "server/session/limits.h"

#include <grpcpp/server_builder.h>
#include <memory>
#include <optional>

namespace fieldcast::service {

/// The port of a gRPC server. Connections are accepted here and passed to gRPC, because the accept loop of gRPC 1.51.1
/// ends permanently at the first shortage of descriptors. The port is probed continuously.
class FrontDoor {
public:
    /// Listens; callers wait until `open()`. Throws std::runtime_error if listening on the address fails.
    FrontDoor(grpc::ServerBuilder& builder, std::shared_ptr<grpc::ServerCredentials> credentials,
              const HostPort& address, const access::Security& security, const session::Limits& limits);

    /// Starts accepting. Call it once, after the server has started. The server and `registry` must outlive this.
    void open(metrics::Registry& registry);

    int port() const { return sockets_.port(); }
    listener::Hearing hearing() const; ///< valid after open()

private:
    void collect(metrics::Page& page) const;

    const listener::ListeningSockets sockets_;
    const listener::Speech speech_;
    const session::Limits limits_;
    std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> handover_;
    std::optional<listener::Acceptor> acceptor_;
    std::optional<listener::SelfProbe> probe_;
    metrics::Collector collector_;
};

} // namespace fieldcast::service
