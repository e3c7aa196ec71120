// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "server/listener/listening_sockets.h"
#include "server/listener/wakeup.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>

namespace fieldcast::listener {

/// Accepts connections and passes them on, in a thread of its own. No error of accept() ends it: after a shortage of
/// descriptors it accepts again as soon as there are some. Connections beyond the largest number are closed at once.
class Acceptor {
public:
    /// Receives a connection accepted at the socket `listening`; the callee closes `connection`.
    using Take = std::function<void(int listening, int connection)>;

    /// Throws std::system_error. `sockets` must outlive this.
    Acceptor(const ListeningSockets& sockets, std::size_t max_connections, Take take);

    /// Connections from this port of this machine are always accepted and not counted: they are the server's
    /// self-probe.
    void let_in_always(int port) { privileged_port_ = port; }

    struct Counts {
        std::size_t open = 0;
        std::uint64_t accepted = 0;
        std::uint64_t refused = 0; ///< closed because the limit was reached
        std::uint64_t failed = 0;  ///< not accepted for lack of descriptors or memory
    };
    Counts counts() const;

private:
    /// An accepted connection. Its descriptor number may be reused later; its cookie is unique.
    struct Handed {
        int number;
        std::uint64_t cookie;
    };
    struct State {
        std::vector<Handed> open;
        Counts counts;
    };

    void accept_until(const std::stop_token& stop);
    bool accept_one(int listening);
    bool is_admitted(int connection);

    const ListeningSockets& sockets_;
    const std::size_t max_connections_;
    const Take take_;
    std::atomic<int> privileged_port_ = 0;
    mutable Guarded<State> state_;
    const Wakeup wakeup_;
    std::jthread thread_;
};

} // namespace fieldcast::listener
