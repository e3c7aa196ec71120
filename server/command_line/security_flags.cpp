// SPDX-License-Identifier: Apache-2.0
#include "server/command_line/security_flags.h"

#include <CLI/CLI.hpp>

namespace fieldcast::command_line {

void add_security_flags(CLI::App& app, SecurityText& text, access::Security& security) {
    const auto add = [&](const char* flag, std::string& value, const char* help) {
        app.add_option(flag, value, help)->group("Security");
    };
    add("--tls-cert", text.tls_cert, "PEM file with the server's certificate and the chain to its authority.");
    add("--tls-key", text.tls_key, "PEM file with the certificate's private key, without passphrase.");
    add("--tls-client-ca", text.tls_client_ca,
        "PEM file with the authorities that must have signed clients' certificates.");
    add("--tokens", text.tokens, "File of tokens that are accepted: lines of NAME ROLE sha256:HEX, see --make-token.");
    app.add_flag(
           "--accept-known-grpc-attacks", security.accepts_known_attacks,
           "Listen beyond loopback although anybody who reaches the port can stop a server with gRPC before 1.57.")
        ->group("Security");
}

void read_security(const SecurityText& text, access::Security& security, std::vector<std::string>& problems) {
    if (!text.tokens.empty()) {
        security.tokens = text.tokens;
    }
    if (text.tls_cert.empty() != text.tls_key.empty()) {
        problems.emplace_back(text.tls_key.empty() ? "--tls-cert needs --tls-key" : "--tls-key needs --tls-cert");
        return;
    }
    if (text.tls_cert.empty()) {
        if (!text.tls_client_ca.empty()) {
            problems.emplace_back("--tls-client-ca needs --tls-cert and --tls-key");
        }
        return;
    }
    security.certificates = {.certificate = text.tls_cert, .key = text.tls_key, .client_ca = std::nullopt};
    if (!text.tls_client_ca.empty()) {
        security.certificates->client_ca = text.tls_client_ca;
    }
}

} // namespace fieldcast::command_line
