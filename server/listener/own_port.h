// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/listener/descriptor.h"
#include "server/listener/socket_address.h"
#include "server/listener/wakeup.h"

#include <optional>
#include <string>

namespace fieldcast::listener {

/// What the port speaks.
enum class Speech : std::uint8_t {
    kPlain,
    kTls,
    kTlsForKnownClients, ///< asks for certificates that the server itself does not have
};

/// Asks the own port as a caller would: a connection, HTTP/2's preface, a PING, and its answer. Where the port wants a
/// client's certificate, an answer to the handshake has to do. The socket is opened once and kept, so that asking takes
/// no descriptor from the asking side. One thread at a time.
class OwnPort {
public:
    /// `listening`: one of the sockets that are asked. Throws std::system_error.
    OwnPort(int listening, Speech speech);

    /// From which the questions come.
    int local_port() const { return local_port_; }

    /// Why it does not answer within `patience`, or nothing if it does. A stop counts as an answer.
    std::optional<std::string> problem(const Wakeup& wakeup, std::chrono::milliseconds patience);

private:
    SocketAddress target_;
    const Speech speech_;
    Descriptor socket_;
    int local_port_ = 0;
};

} // namespace fieldcast::listener
