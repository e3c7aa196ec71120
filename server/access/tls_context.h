// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/access/certificate.h"
#include "server/access/text_file.h"

#include <memory>
#include <vector>

struct ssl_ctx_st; // OpenSSL's SSL_CTX

namespace fieldcast::access {

/// Tells whether certificate, key or authorities were changed.
std::vector<FileStamp> stamps_of(const CertificateFiles& files);

/// The server's side of TLS 1.2 or newer, for what does not speak gRPC. Follows its files. Not thread-safe.
class TlsContext {
public:
    /// Throws UserError naming the file that is not usable.
    explicit TlsContext(const CertificateFiles& files);

    /// What the next connection begins with, read anew if the files have changed. If they are not usable, that is
    /// logged and what was read before stays in force. The caller owns a reference and ends it with SSL_CTX_free.
    ssl_ctx_st* share();

private:
    using Context = std::unique_ptr<ssl_ctx_st, void (*)(ssl_ctx_st*)>;
    static Context read(const CertificateFiles& files);

    CertificateFiles files_;
    std::vector<FileStamp> stamps_;
    Context context_;
};

} // namespace fieldcast::access
