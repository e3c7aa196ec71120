// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <string>

namespace fieldcast::test {

/// A certificate and its private key, PEM. Made when a test runs, never stored in the repository.
struct Issued {
    std::string certificate;
    std::string key;
};

struct CertificateOptions {
    std::string subject = "localhost";
    std::string names = "DNS:localhost,IP:127.0.0.1"; ///< subjectAltName as OpenSSL writes it
    std::chrono::seconds begins{-60};                 ///< from now
    std::chrono::seconds ends{3600};                  ///< from now
};

/// Signs certificates for one test.
class CertificateAuthority {
public:
    CertificateAuthority();
    ~CertificateAuthority();
    CertificateAuthority(const CertificateAuthority&) = delete;
    CertificateAuthority& operator=(const CertificateAuthority&) = delete;

    std::string certificate() const; ///< PEM
    Issued issue(const CertificateOptions& options = {}) const;

private:
    struct Pair;
    std::unique_ptr<Pair> pair_;
};

} // namespace fieldcast::test
