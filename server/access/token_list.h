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

/// Whom a token belongs to.
struct Identity {
    std::string name;
    Role role = Role::kView;
    TokenHash hash{}; ///< of the token

    bool operator==(const Identity&) const = default;
};

/// The tokens that a server knows, by their hashes. Never changed.
///
///     # comment
///     NAME ROLE sha256:HEX
class TokenList {
public:
    /// A list in which nobody stands.
    TokenList() = default;

    /// Throws UserError naming file and line, and nothing of what the line says: it may hold a token by mistake. A file
    /// without tokens is fine.
    static TokenList read(const std::filesystem::path& file);
    static TokenList parse(std::string_view text, const std::string& place);

    /// As `read`, except that lines with a mistake count for nobody and `problems` gets what they would have thrown. Of
    /// lines with the same name or hash none counts. Still throws if the file as a whole cannot be used.
    static TokenList read_good_lines(const std::filesystem::path& file, std::vector<std::string>& problems);

    /// Whose `token` is. Compares with every entry, in a time that does not depend on the token.
    std::optional<Identity> find(std::string_view token) const;

    bool contains(const Identity& identity) const;
    std::size_t size() const { return entries_.size(); }

private:
    static TokenList parse_good_lines(std::string_view text, const std::string& place,
                                      std::vector<std::string>& problems);

    std::vector<Identity> entries_;
};

/// Names of tokens: 1 to 64 of letters, digits, '.', '_', '-'.
bool is_token_name(std::string_view name);

/// A line for a token file.
std::string token_line(const Identity& identity);

} // namespace fieldcast::access
