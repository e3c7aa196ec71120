// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace fieldcast::client::net {

/// TLS and token for connections to a server. The files are read for each new connection, so renewed files take effect.
struct Access {
    bool uses_tls = false;
    std::filesystem::path tls_ca{};          ///< PEM: authorities for the server's certificate; empty: the system's
    std::filesystem::path tls_certificate{}; ///< PEM: ours, for servers that require one; with `tls_key`
    std::filesystem::path tls_key{};         ///< PEM: private key of `tls_certificate`
    std::string tls_name{};             ///< the server's name in its certificate; empty: the host of the address
    std::filesystem::path token_file{}; ///< first line that is neither empty nor a comment (#)
    std::string token{};                ///< used if `token_file` is empty; empty: no token
};

/// The token of `access`; empty: none. Throws UserError, whose message never contains the token.
std::string read_token(const Access& access);

/// The content of a PEM file. Throws UserError.
std::string read_pem(const std::filesystem::path& file);

/// Takes "https://" or "grpcs://" off `address` and turns TLS on; takes "http://" and "grpc://" off. Throws UserError
/// for anything else with "://".
std::string without_scheme(const std::string& address, Access& access);

} // namespace fieldcast::client::net
