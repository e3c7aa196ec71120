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

/// Reads one line that is neither empty nor a comment.
Identity parse_line(const std::string& line) {
    std::istringstream words(line);
    std::string name;
    std::string role_word;
    std::string hash_word;
    std::string rest;
    words >> name >> role_word >> hash_word;
    if (hash_word.empty() || words >> rest) {
        throw UserError("expected NAME ROLE sha256:HEX, as --make-token prints it");
    }
    if (!is_token_name(name)) {
        throw UserError("the name must have 1 to 64 letters, digits, '.', '_' or '-'");
    }
    const auto role = parse_role(role_word);
    if (!role) {
        throw UserError("the role must be view, steer or admin");
    }
    const bool has_prefix = hash_word.starts_with(kHashPrefix);
    const auto hash = has_prefix ? parse_hash(std::string_view(hash_word).substr(kHashPrefix.size())) : std::nullopt;
    if (!hash) {
        throw UserError("the third word must be sha256: and 64 hexadecimal digits, never the token itself");
    }
    return {.name = name, .role = *role, .hash = *hash};
}

/// The lines that were read so far.
class Entries {
public:
    /// Throws UserError if an earlier line has the same name or hash; that line is then ignored, too.
    void add(Identity entry, int line) {
        if (lines_.size() == kMaxEntries) {
            throw UserError("there are more than " + std::to_string(kMaxEntries) + " tokens");
        }
        for (Line& earlier : lines_) {
            const bool is_same_name = earlier.entry.name == entry.name;
            if (is_same_name || earlier.entry.hash == entry.hash) {
                const std::string what = is_same_name ? "the name '" + entry.name + "'" : std::string("this hash");
                const std::string problem = what + " is in line " + std::to_string(earlier.number) + ", too";
                earlier.counts = false;
                lines_.push_back({.entry = std::move(entry), .number = line, .counts = false}); // invalidates `earlier`
                throw UserError(problem);
            }
        }
        lines_.push_back({.entry = std::move(entry), .number = line, .counts = true});
    }

    std::vector<Identity> take() {
        std::vector<Identity> counted;
        for (Line& line : lines_) {
            if (line.counts) {
                counted.push_back(std::move(line.entry));
            }
        }
        return counted;
    }

private:
    struct Line {
        Identity entry;
        int number = 0;
        bool counts = true;
    };
    std::vector<Line> lines_;
};

std::string text_of(const std::filesystem::path& file) {
    if (is_writable_by_all(file)) {
        throw UserError(file.string() + ": all users of this machine may write to it; run chmod o-w");
    }
    return read_text_file(file, kMaxFileBytes);
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
    return parse(text_of(file), file.string());
}

TokenList TokenList::read_good_lines(const std::filesystem::path& file, std::vector<std::string>& problems) {
    return parse_good_lines(text_of(file), file.string(), problems);
}

TokenList TokenList::parse(std::string_view text, const std::string& place) {
    std::vector<std::string> problems;
    TokenList list = parse_good_lines(text, place, problems);
    if (!problems.empty()) {
        throw UserError(problems.front());
    }
    return list;
}

TokenList TokenList::parse_good_lines(std::string_view text, const std::string& place,
                                      std::vector<std::string>& problems) {
    Entries entries;
    std::istringstream lines{std::string(text)};
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        const std::size_t begin = line.find_first_not_of(" \t\r");
        if (begin == std::string::npos || line[begin] == '#') {
            continue;
        }
        try {
            entries.add(parse_line(line), number);
        } catch (const UserError& problem) {
            problems.push_back(place + ":" + std::to_string(number) + ": " + problem.what());
        }
    }
    TokenList list;
    list.entries_ = entries.take();
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
