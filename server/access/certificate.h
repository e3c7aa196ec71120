// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

namespace fieldcast::access {

/// Files of a server's TLS identity, all PEM.
struct CertificateFiles {
    std::filesystem::path certificate;              ///< the server's, followed by its intermediates
    std::filesystem::path key;                      ///< private key without passphrase
    std::optional<std::filesystem::path> client_ca; ///< clients must have a certificate from these authorities
};

/// Subject and expiry of the server's certificate, for logs and metrics.
struct CertificateFacts {
    std::string subject;
    std::chrono::system_clock::time_point expires;
};

/// Reads and checks all files: they are PEM, the key belongs to the certificate, the certificate is valid at `now`.
/// Throws UserError that names the file and the remedy, and nothing of the key's content.
CertificateFacts check_certificate(const CertificateFiles& files, std::chrono::system_clock::time_point now);

/// UTC as text, "2026-07-31T12:00:00Z".
std::string to_text(std::chrono::system_clock::time_point time);

} // namespace fieldcast::access
