// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/listener/descriptor.h"
#include "server/listener/socket_address.h"
#include "server/listener/wakeup.h"

#include <optional>
#include <string>

namespace fieldcast::listener {

/// Protocol of the port.
enum class Speech : std::uint8_t {
    kPlain,
    kTls,
    kTlsForKnownClients, ///< requires client certificates, which the server itself does not have
};

/// Probes the server's own port as a client does: it connects, sends HTTP/2's preface and a PING, and waits for the
/// answer. If the port requires a client certificate, any answer to the TLS handshake is enough. The socket is opened
/// once and reused, so a probe needs no new descriptor on this side. One thread at a time.
class OwnPort {
public:
    /// `listening`: one of the sockets of the port. Throws std::system_error.
    OwnPort(int listening, Speech speech);

    /// Local port from which the probes come.
    int local_port() const { return local_port_; }

    /// Why there is no answer within `patience`, or nothing if there is one. A stop request counts as an answer.
    std::optional<std::string> problem(const Wakeup& wakeup, std::chrono::milliseconds patience);

private:
    SocketAddress target_;
    const Speech speech_;
    Descriptor socket_;
    int local_port_ = 0;
};

} // namespace fieldcast::listener
