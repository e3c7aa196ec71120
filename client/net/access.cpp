// SPDX-License-Identifier: Apache-2.0
#include "client/net/access.h"

#include "core/base/error.h"

#include <algorithm>
#include <fstream>
#include <utility>

namespace fieldcast::client::net {
namespace {

constexpr std::size_t kMaxTokenBytes = 256;
constexpr std::size_t kMaxTokenLines = 64;
constexpr std::size_t kMaxPemBytes = 4U << 20;

/// Without the white space around it, which editors and shells add.
std::string trimmed(const std::string& line) {
    constexpr const char* kSpace = " \t\r\n";
    const std::size_t begin = line.find_first_not_of(kSpace);
    return begin == std::string::npos ? "" : line.substr(begin, line.find_last_not_of(kSpace) - begin + 1);
}

/// `source` names the place, for people.
std::string checked_token(const std::string& text, const std::string& source) {
    std::string token = trimmed(text);
    const auto is_visible = [](char c) { return c > 0x20 && c < 0x7F; };
    if (token.size() > kMaxTokenBytes || !std::all_of(token.begin(), token.end(), is_visible)) {
        throw UserError(source + ": holds no token (one word of at most 256 visible ASCII characters)");
    }
    return token;
}

} // namespace

std::string read_token(const Access& access) {
    if (access.token_file.empty()) {
        return checked_token(access.token, "FIELDCAST_TOKEN");
    }
    const std::string name = access.token_file.string();
    std::ifstream file(access.token_file);
    if (!file) {
        throw UserError("--token-file " + name + ": cannot be read");
    }
    std::size_t count = 0;
    for (std::string line; count < kMaxTokenLines && std::getline(file, line); ++count) {
        const std::string text = trimmed(line);
        if (!text.empty() && text.front() != '#') {
            return checked_token(text, "--token-file " + name);
        }
    }
    throw UserError("--token-file " + name + ": there is no token in it");
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
