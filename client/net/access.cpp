// SPDX-License-Identifier: Apache-2.0
#include "client/net/access.h"

#include "core/base/bearer_token.h"
#include "core/base/error.h"

#include <algorithm>
#include <fstream>

namespace fieldcast::client::net {
namespace {

constexpr std::size_t kMaxPemBytes = 4U << 20;

} // namespace

std::string read_token(const Access& access) {
    return read_bearer_token(access.token_file, access.token, "--token-file");
}

std::string read_pem(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::string text(kMaxPemBytes, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
    if (text.find("-----BEGIN ") == std::string::npos) {
        throw UserError(file.string() + ": cannot be read, or is not in PEM form (-----BEGIN …-----)");
    }
    return text;
}

std::string without_scheme(const std::string& address, Access& access) {
    const std::size_t end = address.find("://");
    if (end == std::string::npos) {
        return address;
    }
    const std::string scheme = address.substr(0, end);
    std::string rest = address.substr(end + 3);
    if (!rest.empty() && rest.back() == '/') {
        rest.pop_back();
    }
    if (scheme == "https" || scheme == "grpcs") {
        access.uses_tls = true;
    } else if (scheme != "http" && scheme != "grpc") {
        throw UserError("--server " + address + ": write HOST:PORT or https://HOST:PORT");
    }
    return rest;
}

} // namespace fieldcast::client::net
