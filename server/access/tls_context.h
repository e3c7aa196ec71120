// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/access/certificate.h"
#include "server/access/text_file.h"

#include <memory>
#include <vector>

struct ssl_ctx_st; // OpenSSL's SSL_CTX

namespace fieldcast::access {

/// Versions of certificate, key and authorities; they differ after a change.
std::vector<FileStamp> stamps_of(const CertificateFiles& files);

/// Server side of TLS 1.2 or newer, for endpoints other than gRPC. Reads its files again when they change. Not
/// thread-safe.
class TlsContext {
public:
    /// Throws UserError that names the unusable file.
    explicit TlsContext(const CertificateFiles& files);

    /// The context for the next connection, made again if the files have changed. If they are not usable, that is
    /// logged and the previous context stays in use. The caller owns a reference and releases it with SSL_CTX_free.
    ssl_ctx_st* share();

private:
    using Context = std::unique_ptr<ssl_ctx_st, void (*)(ssl_ctx_st*)>;
    static Context read(const CertificateFiles& files);

    CertificateFiles files_;
    std::vector<FileStamp> stamps_;
    Context context_;
};

} // namespace fieldcast::access
