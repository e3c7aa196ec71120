// SPDX-License-Identifier: Apache-2.0
#include "server/access/tls_connection.h"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <stdexcept>

namespace fieldcast::access {

struct TlsConnection::State {
    SSL_CTX* context = nullptr;
    SSL* connection = nullptr;

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        SSL_free(connection);
        SSL_CTX_free(context);
        ERR_clear_error();
    }
};

namespace {

void expect(bool is_ok, const char* what) {
    if (!is_ok) {
        throw std::runtime_error(std::string("TLS: ") + what);
    }
}

int no_passphrase(char*, int, int, void*) {
    return 0;
}

} // namespace

TlsConnection::TlsConnection(int socket, const CertificateFiles& files) : state_(std::make_unique<State>()) {
    SSL_CTX* const context = state_->context = SSL_CTX_new(TLS_server_method());
    expect(context != nullptr, "no context");
    SSL_CTX_set_default_passwd_cb(context, no_passphrase);
    expect(SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION) == 1, "version 1.2 is not available");
    expect(SSL_CTX_use_certificate_chain_file(context, files.certificate.c_str()) == 1, "certificate cannot be used");
    expect(SSL_CTX_use_PrivateKey_file(context, files.key.c_str(), SSL_FILETYPE_PEM) == 1, "key cannot be used");
    if (files.client_ca) {
        expect(SSL_CTX_load_verify_locations(context, files.client_ca->c_str(), nullptr) == 1,
               "certificates of clients' authorities cannot be used");
        SSL_CTX_set_verify(context, SSL_VERIFY_PEER | SSL_VERIFY_FAIL_IF_NO_PEER_CERT, nullptr);
    }
    state_->connection = SSL_new(context);
    expect(state_->connection != nullptr && SSL_set_fd(state_->connection, socket) == 1, "no connection");
    expect(SSL_accept(state_->connection) == 1, "the handshake failed");
}

TlsConnection::~TlsConnection() {
    SSL_shutdown(state_->connection); // one way: nobody waits for the answer
}

std::size_t TlsConnection::read(std::span<char> buffer) {
    std::size_t count = 0;
    return SSL_read_ex(state_->connection, buffer.data(), buffer.size(), &count) == 1 ? count : 0;
}

bool TlsConnection::write(std::string_view bytes) {
    std::size_t count = 0;
    return SSL_write_ex(state_->connection, bytes.data(), bytes.size(), &count) == 1 && count == bytes.size();
}

} // namespace fieldcast::access
