// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/access/certificate.h"

#include <memory>
#include <span>
#include <string_view>

namespace fieldcast::access {

/// The server's side of TLS 1.2 or 1.3 on a connected socket, for what does not speak gRPC. Blocks as long as the
/// socket's own timeouts allow. A peer that goes away raises SIGPIPE; block it in the calling thread.
class TlsConnection {
public:
    /// Reads the files and shakes hands. Throws std::runtime_error if either fails. `socket` must outlive this.
    TlsConnection(int socket, const CertificateFiles& files);
    ~TlsConnection();
    TlsConnection(const TlsConnection&) = delete;
    TlsConnection& operator=(const TlsConnection&) = delete;

    /// Number of bytes that came; 0: no more will.
    std::size_t read(std::span<char> buffer);
    bool write(std::string_view bytes);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::access
