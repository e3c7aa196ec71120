// SPDX-License-Identifier: Apache-2.0
#include "core/base/bearer_token.h"

#include "core/base/error.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

namespace fieldcast {

namespace {

constexpr std::size_t kMaxTokenBytes = 256;
constexpr std::size_t kMaxTokenLines = 64;

/// `line` without the white space around it, which editors and shells add.
std::string trimmed(const std::string& line) {
    constexpr const char* kSpace = " \t\r\n";
    const std::size_t begin = line.find_first_not_of(kSpace);
    return begin == std::string::npos ? "" : line.substr(begin, line.find_last_not_of(kSpace) - begin + 1);
}
/// `source` names the origin of `text` in messages.
std::string checked_token(const std::string& text, const std::string& source) {
    std::string token = trimmed(text);
    const auto is_visible = [](char c) { return c > 0x20 && c < 0x7F; };
    if (token.size() > kMaxTokenBytes || !std::all_of(token.begin(), token.end(), is_visible)) {
        throw UserError(source + ": holds no token (one word of at most 256 visible ASCII characters)");
    }
    return token;
}

} // namespace

std::string read_bearer_token(const std::filesystem::path& path, const std::string& fallback, const std::string& flag) {
    if (path.empty()) {
        return checked_token(fallback, kTokenVariable);
    }
    const std::string place = flag + " " + path.string();
    std::ifstream file(path);
    if (!file) {
        throw UserError(place + ": cannot be read");
    }
    std::size_t count = 0;
    for (std::string line; count < kMaxTokenLines && std::getline(file, line); ++count) {
        const std::string text = trimmed(line);
        if (!text.empty() && text.front() != '#') {
            return checked_token(text, place);
        }
    }
    throw UserError(place + ": contains no token");
}

std::string token_of_environment() {
    const char* const token = std::getenv(kTokenVariable);
    return token == nullptr ? "" : token;
}

} // namespace fieldcast
