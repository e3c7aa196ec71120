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

/// The port of a gRPC server. Connections are accepted here and handed to gRPC, whose own accept loop ends for good at
/// the first shortage of descriptors (1.51.1); and the port is asked all the time whether it still answers.
class FrontDoor {
public:
    /// Listens; callers wait until `open()`. Throws std::runtime_error if the address cannot be listened on.
    FrontDoor(grpc::ServerBuilder& builder, std::shared_ptr<grpc::ServerCredentials> credentials,
              const HostPort& address, const access::Security& security, const session::Limits& limits);

    /// Lets callers in. Once, when the server has started; it and `registry` have to outlive this.
    void open(metrics::Registry& registry);

    int port() const { return sockets_.port(); }
    listener::Hearing hearing() const; ///< while it is open

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
