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

/// Accepts connections and hands them on, in a thread of its own. It never stops listening, whatever accept() says: a
/// server that is out of descriptors answers again when it has some. Beyond its number of connections callers are
/// closed at once.
class Acceptor {
public:
    /// Takes a connection that came in at `listening`; `connection` is the callee's to close.
    using Take = std::function<void(int listening, int connection)>;

    /// Throws std::system_error. `sockets` must outlive this.
    Acceptor(const ListeningSockets& sockets, std::size_t max_connections, Take take);

    /// The connection from this port of the machine itself is let in always and not counted: the server's own question.
    void let_in_always(int port) { privileged_port_ = port; }

    struct Counts {
        std::size_t open = 0;
        std::uint64_t accepted = 0;
        std::uint64_t refused = 0; ///< there were enough
        std::uint64_t failed = 0;  ///< accept() had no descriptor or no memory
    };
    Counts counts() const;

private:
    /// A connection that was handed on. Its number may mean another one later, its cookie does not.
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
