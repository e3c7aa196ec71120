// SPDX-License-Identifier: Apache-2.0
#include "http_client.h"

#include <array>
#include <memory>
#include <netdb.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>
#include <stdexcept>
#include <sys/socket.h>
#include <unistd.h>

namespace fieldcast::test {

HttpCaller::HttpCaller(const std::string& address, int port) : descriptor_(-1) {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = AI_NUMERICHOST;
    addrinfo* found = nullptr;
    if (getaddrinfo(address.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) {
        throw std::runtime_error("no such address: " + address);
    }
    descriptor_ = ::socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int result = ::connect(descriptor_, found->ai_addr, found->ai_addrlen);
    freeaddrinfo(found);
    if (result != 0) {
        ::close(descriptor_);
        throw std::runtime_error("cannot connect to port " + std::to_string(port));
    }
    const timeval limit{.tv_sec = 20, .tv_usec = 0}; // then the test fails instead of hanging
    setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
}

HttpCaller::~HttpCaller() {
    ::close(descriptor_);
}

struct HttpsCaller::Tls {
    std::unique_ptr<SSL_CTX, void (*)(SSL_CTX*)> context{SSL_CTX_new(TLS_client_method()), SSL_CTX_free};
    std::unique_ptr<SSL, void (*)(SSL*)> connection{nullptr, SSL_free};
};

HttpsCaller::HttpsCaller(const std::string& address, int port, const std::string& authority)
    : caller_(address, port), tls_(std::make_unique<Tls>()) {
    BIO* const pem = BIO_new_mem_buf(authority.data(), static_cast<int>(authority.size()));
    X509* const root = PEM_read_bio_X509(pem, nullptr, nullptr, nullptr);
    X509_STORE_add_cert(SSL_CTX_get_cert_store(tls_->context.get()), root);
    X509_free(root);
    BIO_free(pem);
    SSL_CTX_set_verify(tls_->context.get(), SSL_VERIFY_PEER, nullptr);
    tls_->connection.reset(SSL_new(tls_->context.get()));
    SSL* const connection = tls_->connection.get();
    X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(connection), address.c_str());
    SSL_set_fd(connection, caller_.descriptor());
    is_trusted_ = SSL_connect(connection) == 1;
}

HttpsCaller::~HttpsCaller() = default;

void HttpsCaller::send(const std::string& text) {
    std::size_t count = 0;
    SSL_write_ex(tls_->connection.get(), text.data(), text.size(), &count);
}

std::string HttpsCaller::rest() {
    std::string answer;
    std::array<char, 4096> buffer{};
    std::size_t count = 0;
    while (SSL_read_ex(tls_->connection.get(), buffer.data(), buffer.size(), &count) == 1) {
        answer.append(buffer.data(), count);
    }
    return answer;
}

std::string rest_of(const HttpCaller& caller) {
    std::string answer;
    std::array<char, 4096> buffer{};
    for (ssize_t count = 1; count > 0;) {
        count = ::recv(caller.descriptor(), buffer.data(), buffer.size(), 0);
        answer.append(buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    }
    return answer;
}

std::string http_get(int port, const std::string& request, const std::string& address) {
    const HttpCaller caller(address, port);
    ::send(caller.descriptor(), request.data(), request.size(), MSG_NOSIGNAL);
    return rest_of(caller);
}

std::string https_get(int port, const std::string& request, const std::string& authority, const std::string& address) {
    HttpsCaller caller(address, port, authority);
    if (!caller.is_trusted()) {
        return "";
    }
    caller.send(request);
    return caller.rest();
}

} // namespace fieldcast::test
