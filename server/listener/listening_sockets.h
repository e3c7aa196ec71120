// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/host_port.h"
#include "server/listener/descriptor.h"

#include <chrono>
#include <vector>

namespace fieldcast::listener {

/// One port on every address that a host name stands for. Callers who shake no hands are accepted by the kernel from
/// the constructor on.
class ListeningSockets {
public:
    /// Port 0: any free one. What is written to a caller and not acknowledged for `silence` ends its connection. Throws
    /// std::runtime_error if the address cannot be listened on.
    ListeningSockets(const HostPort& address, std::chrono::milliseconds silence);

    int port() const { return port_; }
    const std::vector<Descriptor>& all() const { return all_; }

private:
    std::vector<Descriptor> all_;
    int port_ = 0;
};

} // namespace fieldcast::listener
