// SPDX-License-Identifier: Apache-2.0
#include "server/access/token_list.h"

#include "core/base/error.h"
#include "server/access/text_file.h"

#include <algorithm>
#include <cctype>
#include <sstream>

namespace fieldcast::access {

namespace {

constexpr std::size_t kMaxFileBytes = 1U << 20;
constexpr std::size_t kMaxEntries = 4096;
constexpr std::size_t kMaxNameBytes = 64;
constexpr std::string_view kHashPrefix = "sha256:";

/// Reads one line that is neither empty nor a comment; `place` is file and line.
Identity parse_line(const std::string& line, const std::string& place) {
    std::istringstream words(line);
    std::string name;
    std::string role_word;
    std::string hash_word;
    std::string rest;
    words >> name >> role_word >> hash_word;
    if (hash_word.empty() || words >> rest) {
        throw UserError(place + ": a line is NAME ROLE sha256:HEX, as --make-token prints it");
    }
    if (!is_token_name(name)) {
        throw UserError(place + ": a name has 1 to 64 letters, digits, '.', '_' or '-'");
    }
    const auto role = parse_role(role_word);
    if (!role) {
        throw UserError(place + ": a role is view, steer or admin");
    }
    const bool has_prefix = hash_word.starts_with(kHashPrefix);
    const auto hash = has_prefix ? parse_hash(std::string_view(hash_word).substr(kHashPrefix.size())) : std::nullopt;
    if (!hash) {
        throw UserError(place + ": the third word is sha256: and 64 hexadecimal digits, never the token itself");
    }
    return {.name = name, .role = *role, .hash = *hash};
}

} // namespace

bool is_token_name(std::string_view name) {
    const auto is_allowed = [](unsigned char c) { return std::isalnum(c) != 0 || c == '.' || c == '_' || c == '-'; };
    return !name.empty() && name.size() <= kMaxNameBytes && std::ranges::all_of(name, is_allowed);
}

std::string token_line(const Identity& identity) {
    return identity.name + " " + std::string(to_text(identity.role)) + " " + std::string(kHashPrefix) +
           to_hex(identity.hash);
}

TokenList TokenList::read(const std::filesystem::path& file) {
    if (is_writable_by_all(file)) {
        throw UserError(file.string() + ": everybody on this machine may write to it; chmod o-w");
    }
    return parse(read_text_file(file, kMaxFileBytes), file.string());
}

TokenList TokenList::parse(std::string_view text, const std::string& place) {
    TokenList list;
    std::istringstream lines{std::string(text)};
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        const std::string here = place + ":" + std::to_string(++number);
        const std::size_t begin = line.find_first_not_of(" \t\r");
        if (begin == std::string::npos || line[begin] == '#') {
            continue;
        }
        Identity entry = parse_line(line, here);
        if (std::ranges::find(list.entries_, entry.name, &Identity::name) != list.entries_.end()) {
            throw UserError(here + ": the name '" + entry.name + "' stands in an earlier line, too");
        }
        if (std::ranges::find(list.entries_, entry.hash, &Identity::hash) != list.entries_.end()) {
            throw UserError(here + ": this hash stands in an earlier line, too");
        }
        if (list.entries_.size() == kMaxEntries) {
            throw UserError(here + ": there are more than " + std::to_string(kMaxEntries) + " tokens");
        }
        list.entries_.push_back(std::move(entry));
    }
    if (list.entries_.empty()) {
        throw UserError(place + ": there is no token in it; make one with --make-token");
    }
    return list;
}

std::optional<Identity> TokenList::find(std::string_view token) const {
    const TokenHash hash = hash_token(token);
    const Identity* found = nullptr;
    for (const Identity& entry : entries_) {
        found = is_equal(entry.hash, hash) ? &entry : found;
    }
    return found == nullptr ? std::nullopt : std::optional(*found);
}

bool TokenList::contains(const Identity& identity) const {
    return std::ranges::find(entries_, identity) != entries_.end();
}

} // namespace fieldcast::access
