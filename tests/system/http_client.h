// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

namespace fieldcast::test {

/// A connection that has not said anything yet.
class HttpCaller {
public:
    /// Throws std::runtime_error.
    HttpCaller(const std::string& address, int port);
    ~HttpCaller();
    HttpCaller(const HttpCaller&) = delete;
    HttpCaller& operator=(const HttpCaller&) = delete;

    int descriptor() const { return descriptor_; }

private:
    int descriptor_;
};

/// A connection over TLS that has shaken hands and not said anything yet.
class HttpsCaller {
public:
    /// `authority`: PEM. Throws std::runtime_error if nobody answers.
    HttpsCaller(const std::string& address, int port, const std::string& authority);
    ~HttpsCaller();
    HttpsCaller(const HttpsCaller&) = delete;
    HttpsCaller& operator=(const HttpsCaller&) = delete;

    /// False if the server's certificate is not signed by the authority, or names another address.
    bool is_trusted() const { return is_trusted_; }

    void send(const std::string& text);
    std::string rest(); ///< everything that comes until the end
    int descriptor() const { return caller_.descriptor(); }

private:
    struct Tls;
    HttpCaller caller_;
    std::unique_ptr<Tls> tls_;
    bool is_trusted_;
};

/// What comes until the other side closes.
std::string rest_of(const HttpCaller& caller);

/// Everything that comes back for `request`, given as it is.
std::string http_get(int port, const std::string& request, const std::string& address = "127.0.0.1");

/// The same over TLS; empty if the server's certificate is not signed by `authority` (PEM) or names another address.
std::string https_get(int port, const std::string& request, const std::string& authority,
                      const std::string& address = "127.0.0.1");

} // namespace fieldcast::test
