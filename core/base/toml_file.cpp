// SPDX-License-Identifier: Apache-2.0
#include "core/base/toml_file.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>
#include <sstream>
#include <toml++/toml.h>

namespace fieldcast {

namespace {

constexpr std::size_t kMaxFileBytes = 1U << 20;
constexpr std::size_t kMaxTextBytes = 4096;
constexpr std::size_t kMaxValues = 256;
constexpr std::size_t kMaxTables = 256;
constexpr int kMaxDepth = 4;

template <class T> std::string number_text(T number) {
    char buffer[64];
    const auto [end, error] = std::to_chars(std::begin(buffer), std::end(buffer), number);
    return error == std::errc{} ? std::string(std::begin(buffer), end) : "";
}

/// A scalar value as text; empty for types that settings do not have, and for long strings.
std::optional<std::string> text_of(const toml::node& node) {
    if (const auto* text = node.as_string()) {
        return text->get().size() <= kMaxTextBytes ? std::optional(text->get()) : std::nullopt;
    }
    if (const auto* number = node.as_integer()) {
        return number_text(number->get());
    }
    if (const auto* number = node.as_floating_point()) {
        return number_text(number->get());
    }
    if (const auto* truth = node.as_boolean()) {
        return truth->get() ? "true" : "false";
    }
    return std::nullopt;
}

/// Adds the values of `node` to `entry`; false if one of them is not supported.
bool add_values(const toml::node& node, TomlEntry& entry) {
    const toml::array* const array = node.as_array();
    if (array == nullptr) {
        entry.is_switch = node.is_boolean();
        const auto text = text_of(node);
        entry.values.push_back(text.value_or(""));
        return text.has_value();
    }
    for (const toml::node& element : *array) {
        const auto text = text_of(element);
        if (!text || entry.values.size() == kMaxValues) {
            return false;
        }
        entry.values.push_back(*text);
    }
    return true;
}

std::string place_of(const std::string& place, const toml::key& key) {
    return place + ":" + std::to_string(key.source().begin.line) + ": " + std::string(key.str());
}

void add_entry(const std::string& place, const toml::key& key, const toml::node& node,
               std::vector<TomlEntry>& entries, std::vector<std::string>& problems) {
    TomlEntry entry{.key = std::string(key.str()),
                    .values = {},
                    .is_switch = false,
                    .line = static_cast<int>(key.source().begin.line)};
    if (add_values(node, entry)) {
        entries.push_back(std::move(entry));
        return;
    }
    problems.push_back(place_of(place, key) + ": write a string of at most " + std::to_string(kMaxTextBytes) +
                       " bytes, a number, true or false, or an array of at most " + std::to_string(kMaxValues) +
                       " of these");
}

/// The parsed file. If it cannot be parsed, the result is empty and `problems` says why.
std::optional<toml::table> parse_file(const std::filesystem::path& file, std::vector<std::string>& problems) {
    const std::string place = file.string();
    std::ifstream stream(file, std::ios::binary);
    std::error_code error;
    if (!stream || !std::filesystem::is_regular_file(file, error)) {
        problems.push_back(place + ": cannot be read");
        return std::nullopt;
    }
    std::string text(kMaxFileBytes + 1, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    if (text.size() > kMaxFileBytes) {
        problems.push_back(place + ": is larger than 1 MiB");
        return std::nullopt;
    }
    try {
        return toml::parse(text, place);
    } catch (const toml::parse_error& problem) {
        const std::string line = std::to_string(problem.source().begin.line);
        problems.push_back(place + ":" + line + ": " + std::string(problem.description()));
        return std::nullopt;
    }
}

/// Converts a table of toml++ into a TomlTree.
class TreeReader {
public:
    TreeReader(std::string place, std::vector<std::string>& problems) : place_(std::move(place)), problems_(problems) {}

    void read(const toml::table& table, TomlTable& result, int depth) {
        for (const auto& [key, node] : table) {
            if (const auto* child = node.as_table()) {
                add_child(key, *child, result, depth);
            } else if (node.is_array_of_tables()) {
                node.as_array()->for_each([&, &name = key](const toml::table& element) {
                    add_child(name, element, result, depth);
                });
            } else {
                add_entry(place_, key, node, result.entries, problems_);
            }
        }
        std::ranges::stable_sort(result.entries, {}, &TomlEntry::line);
        std::ranges::stable_sort(result.children, {}, &TomlTable::line);
    }

private:
    void add_child(const toml::key& key, const toml::table& table, TomlTable& result, int depth) {
        if (depth == kMaxDepth || ++count_ > kMaxTables) {
            problems_.push_back(place_of(place_, key) + ": at most " + std::to_string(kMaxTables) + " tables, " +
                                std::to_string(kMaxDepth) + " deep");
            return;
        }
        TomlTable child{.name = std::string(key.str()),
                        .line = static_cast<int>(table.source().begin.line),
                        .entries = {},
                        .children = {}};
        read(table, child, depth + 1);
        result.children.push_back(std::move(child));
    }

    std::string place_;
    std::vector<std::string>& problems_;
    std::size_t count_ = 0;
};

} // namespace

TomlFile read_toml(const std::filesystem::path& file) {
    TomlFile result;
    const std::optional<toml::table> table = parse_file(file, result.problems);
    if (!table) {
        result.is_parsed = false;
        return result;
    }
    for (const auto& [key, node] : *table) {
        if (node.is_table() || node.is_array_of_tables()) {
            result.problems.push_back(place_of(file.string(), key) +
                                      ": settings stand at the top level, without [sections]");
        } else {
            add_entry(file.string(), key, node, result.entries, result.problems);
        }
    }
    std::ranges::stable_sort(result.entries, {}, &TomlEntry::line);
    return result;
}

TomlTree read_toml_tree(const std::filesystem::path& file) {
    TomlTree result;
    if (const std::optional<toml::table> table = parse_file(file, result.problems)) {
        TreeReader(file.string(), result.problems).read(*table, result.root, 0);
    }
    return result;
}

std::string toml_quoted(std::string_view text) {
    std::string quoted = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            quoted += '\\';
            quoted += c;
        } else if (byte < 0x20 || byte == 0x7F) {
            constexpr std::string_view kDigits = "0123456789abcdef";
            quoted += "\\u00";
            quoted += kDigits[byte >> 4U];
            quoted += kDigits[byte & 0xFU];
        } else {
            quoted += c;
        }
    }
    return quoted + '"';
}

} // namespace fieldcast
