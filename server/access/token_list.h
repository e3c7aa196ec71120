// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/access/role.h"
#include "server/access/token.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fieldcast::access {

/// Holder of a token: name and role.
struct Identity {
    std::string name;
    Role role = Role::kView;
    TokenHash hash{}; ///< of the token

    bool operator==(const Identity&) const = default;
};

/// The valid tokens of a server, stored as hashes. Immutable. Its file has one line per token:
///
///     # comment
///     NAME ROLE sha256:HEX
class TokenList {
public:
    /// An empty list: no token is valid.
    TokenList() = default;

    /// Throws UserError that names file and line, but does not quote the line: it may contain a token by mistake. A
    /// file without tokens is allowed.
    static TokenList read(const std::filesystem::path& file);
    static TokenList parse(std::string_view text, const std::string& place);

    /// The same, except that lines with a mistake are ignored and their errors are appended to `problems`. All lines
    /// with the same name or the same hash are ignored, too. Throws UserError if the file as a whole is not usable.
    static TokenList read_good_lines(const std::filesystem::path& file, std::vector<std::string>& problems);

    /// The holder of `token`, or nothing. Compares with every entry, so the time does not depend on the token.
    std::optional<Identity> find(std::string_view token) const;

    bool contains(const Identity& identity) const;
    std::size_t size() const { return entries_.size(); }

private:
    static TokenList parse_good_lines(std::string_view text, const std::string& place,
                                      std::vector<std::string>& problems);

    std::vector<Identity> entries_;
};

/// Whether `name` is a valid name of a token: 1 to 64 letters, digits, '.', '_' or '-'.
bool is_token_name(std::string_view name);

/// The line of a token file for this identity.
std::string token_line(const Identity& identity);

} // namespace fieldcast::access
