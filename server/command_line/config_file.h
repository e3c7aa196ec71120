// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace fieldcast::command_line {

/// Where a flag's value was read: "--fps" -> "server.toml:3".
using Places = std::map<std::string, std::string>;

/// A --config file as arguments of a command line.
struct FileArguments {
    std::vector<std::string> arguments; ///< "--fps=12"
    Places places;
    std::vector<std::string> problems; ///< each with file, line and key
    bool is_parsed = true;             ///< false: the problem is the file as a whole
};

/// What is wrong with a flag's value, for people.
std::string problem_text(const CLI::ParseError& error, const CLI::App& app);

/// Keys are the long names of `app`'s flags without dashes. Flags that `app` has been given are left out: they win.
FileArguments read_config_file(const std::filesystem::path& file, const CLI::App& app);

/// "--fps 0: more than 0" -> "server.toml:3: fps 0: more than 0", if that is where --fps comes from.
std::string with_place(const std::string& problem, const Places& places);

/// The flag's name from "--fps=12".
std::string flag_name(const std::string& argument);

/// The flag of `app` that resembles `name` ("--fsp") most; empty: none does.
std::string nearest_flag(const std::string& name, const CLI::App& app);

/// The one of `words` that may have been meant; empty if none is near.
std::string nearest_word(const std::string& word, const std::vector<std::string>& words);

/// What is set, or has a default, as a file that `read_config_file` reads.
std::string config_text(const CLI::App& app);

} // namespace fieldcast::command_line
