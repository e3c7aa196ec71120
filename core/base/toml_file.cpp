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

template <class T> std::string number_text(T number) {
    char buffer[64];
    const auto [end, error] = std::to_chars(std::begin(buffer), std::end(buffer), number);
    return error == std::errc{} ? std::string(std::begin(buffer), end) : "";
}

/// A single value; nothing if it is of a kind that no setting has.
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

/// Adds `key = node` to `entry`; false if a part of it is of no use.
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

void add_entry(const std::string& place, const toml::key& key, const toml::node& node, TomlFile& result) {
    TomlEntry entry{.key = std::string(key.str()),
                    .values = {},
                    .is_switch = false,
                    .line = static_cast<int>(key.source().begin.line)};
    const std::string here = place + ":" + std::to_string(entry.line) + ": " + entry.key;
    if (node.is_table() || node.is_array_of_tables()) {
        result.problems.push_back(here + ": settings stand at the top level, without [sections]");
    } else if (!add_values(node, entry)) {
        result.problems.push_back(here + ": write a text of at most " + std::to_string(kMaxTextBytes) +
                                  " bytes, a number, true or false, or an array of at most " +
                                  std::to_string(kMaxValues) + " of these");
    } else {
        result.entries.push_back(std::move(entry));
    }
}

} // namespace

TomlFile read_toml(const std::filesystem::path& file) {
    const std::string place = file.string();
    std::ifstream stream(file, std::ios::binary);
    std::error_code error;
    if (!stream || !std::filesystem::is_regular_file(file, error)) {
        return {.entries = {}, .problems = {place + ": cannot be read"}};
    }
    std::string text(kMaxFileBytes + 1, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    if (text.size() > kMaxFileBytes) {
        return {.entries = {}, .problems = {place + ": is larger than 1 MiB"}};
    }
    TomlFile result;
    try {
        const toml::table table = toml::parse(text, place);
        for (const auto& [key, node] : table) {
            add_entry(place, key, node, result);
        }
    } catch (const toml::parse_error& problem) {
        const std::string line = std::to_string(problem.source().begin.line);
        result.problems.push_back(place + ":" + line + ": " + std::string(problem.description()));
    }
    std::ranges::stable_sort(result.entries, {}, &TomlEntry::line);
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
