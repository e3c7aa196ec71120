// SPDX-License-Identifier: Apache-2.0
#include "server/access/tls_context.h"

#include "core/base/error.h"
#include "core/base/log.h"

#include <openssl/err.h>
#include <openssl/ssl.h>

namespace fieldcast::access {

namespace {

void expect(bool is_ok, const std::string& what) {
    if (!is_ok) {
        ERR_clear_error();
        throw UserError(what);
    }
}

int no_passphrase(char*, int, int, void*) {
    return 0;
}

} // namespace

std::vector<FileStamp> stamps_of(const CertificateFiles& files) {
    std::vector<FileStamp> stamps{stamp_of(files.certificate), stamp_of(files.key)};
    if (files.client_ca) {
        stamps.push_back(stamp_of(*files.client_ca));
    }
    return stamps;
}

TlsContext::TlsContext(const CertificateFiles& files)
    : files_(files), stamps_(stamps_of(files)), // before reading, so that a change in between is noticed later
      context_(read(files)) {}

TlsContext::Context TlsContext::read(const CertificateFiles& files) {
    check_certificate(files, std::chrono::system_clock::now());
    Context owner(SSL_CTX_new(TLS_server_method()), SSL_CTX_free);
    SSL_CTX* const context = owner.get();
    expect(context != nullptr && SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION) == 1,
           "TLS 1.2 is not available");
    SSL_CTX_set_default_passwd_cb(context, no_passphrase);
    SSL_CTX_set_session_cache_mode(context, SSL_SESS_CACHE_OFF); // keeps no memory of closed connections
    SSL_CTX_set_options(context, SSL_OP_NO_TICKET | SSL_OP_NO_RENEGOTIATION);
    SSL_CTX_set_num_tickets(context, 0);
    expect(SSL_CTX_use_certificate_chain_file(context, files.certificate.c_str()) == 1,
           files.certificate.string() + ": cannot be used as a certificate for TLS");
    expect(SSL_CTX_use_PrivateKey_file(context, files.key.c_str(), SSL_FILETYPE_PEM) == 1,
           files.key.string() + ": cannot be used as a key for TLS");
    if (files.client_ca) {
        expect(SSL_CTX_load_verify_locations(context, files.client_ca->c_str(), nullptr) == 1,
               files.client_ca->string() + ": cannot be used as certificates of the authorities for clients");
        SSL_CTX_set_verify(context, SSL_VERIFY_PEER | SSL_VERIFY_FAIL_IF_NO_PEER_CERT, nullptr);
    }
    return owner;
}

ssl_ctx_st* TlsContext::share() {
    const std::vector<FileStamp> stamps = stamps_of(files_);
    if (stamps != stamps_) {
        stamps_ = stamps;
        try {
            context_ = read(files_);
        } catch (const std::exception& problem) {
            log::error("certificate not replaced, the previous one stays in use", {{"problem", problem.what()}});
        }
    }
    SSL_CTX_up_ref(context_.get());
    return context_.get();
}

} // namespace fieldcast::access
