// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

namespace fieldcast::access {

/// What a server shows its clients, all of it PEM.
struct CertificateFiles {
    std::filesystem::path certificate;              ///< the server's, followed by what links it to a root
    std::filesystem::path key;                      ///< without passphrase
    std::optional<std::filesystem::path> client_ca; ///< clients must show a certificate that these sign
};

/// The server's certificate, for people.
struct CertificateFacts {
    std::string subject;
    std::chrono::system_clock::time_point expires;
};

/// Reads and checks all files: PEM, key and certificate belong together, valid `now`. Throws UserError naming the file
/// and what to do; says nothing of the key's content.
CertificateFacts check_certificate(const CertificateFiles& files, std::chrono::system_clock::time_point now);

/// "2026-07-31T12:00:00Z"
std::string to_text(std::chrono::system_clock::time_point time);

} // namespace fieldcast::access
