// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace fieldcast::client::net {

/// How to reach a server that not everybody may use. Files are read for each new connection, so that renewed ones are
/// taken up.
struct Access {
    bool uses_tls = false;
    std::filesystem::path tls_ca{};          ///< PEM: who may have signed the server's certificate; empty: the system's
    std::filesystem::path tls_certificate{}; ///< PEM: ours, for servers that ask for one; together with `tls_key`
    std::filesystem::path tls_key{};
    std::string tls_name{};             ///< the server's name in its certificate; empty: the host that is dialled
    std::filesystem::path token_file{}; ///< first line that is neither empty nor a comment (#)
    std::string token{};                ///< without `token_file`; empty: none
};

/// The token of `access`; empty: none. Throws UserError, which never shows it.
std::string read_token(const Access& access);

/// All of a PEM file. Throws UserError.
std::string read_pem(const std::filesystem::path& file);

/// Takes "https://" or "grpcs://" off `address` and turns TLS on; takes "http://" and "grpc://" off. Throws UserError
/// for anything else with "://".
std::string without_scheme(const std::string& address, Access& access);

} // namespace fieldcast::client::net
