// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/host_port.h"
#include "server/listener/descriptor.h"

#include <chrono>
#include <vector>

namespace fieldcast::listener {

/// Sockets that listen at one port of every address of a host name. The kernel completes connections from the
/// constructor on.
class ListeningSockets {
public:
    /// Port 0: any free one. A connection ends if written data is not acknowledged for `silence`. Throws
    /// std::runtime_error if listening on the address fails.
    ListeningSockets(const HostPort& address, std::chrono::milliseconds silence);

    int port() const { return port_; }
    const std::vector<Descriptor>& all() const { return all_; }

private:
    std::vector<Descriptor> all_;
    int port_ = 0;
};

} // namespace fieldcast::listener
