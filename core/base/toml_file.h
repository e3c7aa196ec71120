// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fieldcast {

/// One `key = value` of a TOML file, as text. Numbers are written so that they read back the same.
struct TomlEntry {
    std::string key;
    std::vector<std::string> values; ///< more than one only for arrays
    bool is_switch = false;          ///< the value is true or false
    int line = 0;                    ///< from 1
};

/// A flat file of settings.
struct TomlFile {
    std::vector<TomlEntry> entries;    ///< in the order of their lines
    std::vector<std::string> problems; ///< "FILE:LINE: …", for everything that is not a valid setting
    bool is_parsed = true;             ///< false: the file could not be parsed, so its settings are unknown
};

/// A table of a TOML file: its own settings, and the tables in it.
struct TomlTable {
    std::string name; ///< "group" of [group], of an element of [[group]] and of group = { … }; empty: the file itself
    int line = 0;     ///< from 1
    std::vector<TomlEntry> entries;  ///< in the order of their lines
    std::vector<TomlTable> children; ///< in the order of their lines
};

/// A file with tables in it.
struct TomlTree {
    TomlTable root;
    std::vector<std::string> problems; ///< "FILE:LINE: …", for everything that is not a valid setting
};

/// Like `read_toml`, with at most 256 tables, nested at most four deep.
TomlTree read_toml_tree(const std::filesystem::path& file);

/// Reads `key = value` lines at the top level: strings, numbers, true, false and arrays of these. The file has at most
/// 1 MiB, a string at most 4096 bytes, an array at most 256 values. Never throws because of the file's content.
TomlFile read_toml(const std::filesystem::path& file);

/// `text` as a value in TOML, with quotes.
std::string toml_quoted(std::string_view text);

} // namespace fieldcast
