// SPDX-License-Identifier: Apache-2.0
#include "server/listener/tls_talk.h"

#include <array>
#include <openssl/err.h>
#include <openssl/ssl.h>

namespace fieldcast::listener {

namespace {

constexpr std::array<unsigned char, 3> kHttp2{2, 'h', '2'}; // ALPN: each name after its length

} // namespace

struct TlsTalk::Session {
    std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context{SSL_CTX_new(TLS_client_method()), &SSL_CTX_free};
    std::unique_ptr<SSL, decltype(&SSL_free)> ssl{nullptr, &SSL_free};
};

TlsTalk::TlsTalk(int socket) : session_(std::make_unique<Session>()) {
    session_->ssl.reset(session_->context ? SSL_new(session_->context.get()) : nullptr);
    SSL* const ssl = session_->ssl.get();
    if (ssl == nullptr || SSL_set_fd(ssl, socket) != 1 || SSL_set_alpn_protos(ssl, kHttp2.data(), kHttp2.size()) != 0) {
        throw NoAnswer("no TLS session");
    }
    SSL_set_verify(ssl, SSL_VERIFY_NONE, nullptr);
}

TlsTalk::~TlsTalk() = default;

bool TlsTalk::shake_hands(const Patience& patience) {
    while (true) {
        ERR_clear_error();
        const int result = SSL_connect(session_->ssl.get());
        if (result == 1) {
            return true;
        }
        const int want = SSL_get_error(session_->ssl.get(), result);
        if (want != SSL_ERROR_WANT_READ && want != SSL_ERROR_WANT_WRITE) {
            throw NoAnswer("the TLS handshake failed");
        }
        if (!patience.wait(want == SSL_ERROR_WANT_READ ? POLLIN : POLLOUT)) {
            return false;
        }
    }
}

bool TlsTalk::has_heard() const {
    return BIO_number_read(SSL_get_rbio(session_->ssl.get())) > 0;
}

std::size_t TlsTalk::read(char* into, std::size_t size) {
    ERR_clear_error();
    const int count = SSL_read(session_->ssl.get(), into, static_cast<int>(size));
    if (count > 0) {
        return static_cast<std::size_t>(count);
    }
    if (SSL_get_error(session_->ssl.get(), count) != SSL_ERROR_WANT_READ) {
        throw NoAnswer("the connection ended before an answer");
    }
    return 0;
}

void TlsTalk::write(std::string_view bytes) {
    ERR_clear_error();
    if (SSL_write(session_->ssl.get(), bytes.data(), static_cast<int>(bytes.size())) !=
        static_cast<int>(bytes.size())) {
        throw NoAnswer("the connection accepts no data");
    }
}

} // namespace fieldcast::listener
