// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/listener/talk.h"

#include <memory>

namespace fieldcast::listener {

/// TLS with the server's own port. It verifies no certificate, because the peer is this process.
class TlsTalk final : public Talk {
public:
    explicit TlsTalk(int socket);
    ~TlsTalk() override;

    /// Performs the handshake. Throws NoAnswer. False: the thread must stop.
    bool shake_hands(const Patience& patience);
    /// Whether the other side has sent anything.
    bool has_heard() const;

    std::size_t read(char* into, std::size_t size) override;
    void write(std::string_view bytes) override;

private:
    struct Session;
    std::unique_ptr<Session> session_;
};

} // namespace fieldcast::listener
