// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/listener/talk.h"

#include <memory>

namespace fieldcast::listener {

/// TLS with the own port: nothing is verified, since who answers is known.
class TlsTalk final : public Talk {
public:
    explicit TlsTalk(int socket);
    ~TlsTalk() override;

    /// Throws NoAnswer. False: the thread has to stop.
    bool shake_hands(const Patience& patience);
    /// Whether the other side has said anything.
    bool has_heard() const;

    std::size_t read(char* into, std::size_t size) override;
    void write(std::string_view bytes) override;

private:
    struct Session;
    std::unique_ptr<Session> session_;
};

} // namespace fieldcast::listener
