// SPDX-License-Identifier: Apache-2.0
#include "server/ops/security_flags.h"

#include <CLI/CLI.hpp>

namespace fieldcast::ops {

void add_security_flags(CLI::App& app, FlagText& text, access::Security& security) {
    app.add_option("--tls-cert", text.tls_cert, "PEM file: certificate of the server and what links it to a root")
        ->group("Security");
    app.add_option("--tls-key", text.tls_key, "PEM file: its private key, without passphrase")->group("Security");
    app.add_option("--tls-client-ca", text.tls_client_ca,
                   "PEM file: clients must show a certificate that one of these has signed")
        ->group("Security");
    app.add_option("--tokens", text.tokens, "Who may call: lines of NAME ROLE sha256:HEX, see --make-token")
        ->group("Security");
    app.add_flag("--accept-known-grpc-attacks", security.accepts_known_attacks,
                 "Listen beyond loopback although whoever reaches the port can stop a server with gRPC before 1.57")
        ->group("Security");
}

} // namespace fieldcast::ops
