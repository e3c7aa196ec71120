// SPDX-License-Identifier: Apache-2.0
#pragma once

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

/// Everything that comes back for `request`, given as it is.
std::string http_get(int port, const std::string& request, const std::string& address = "127.0.0.1");

/// The same over TLS; empty if the server's certificate is not signed by `authority` (PEM) or names another address.
std::string https_get(int port, const std::string& request, const std::string& authority,
                      const std::string& address = "127.0.0.1");

} // namespace fieldcast::test
