// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace fieldcast::command_line {

/// Places from which values of flags were read: "--fps" -> "server.toml:3".
using Places = std::map<std::string, std::string>;

/// A --config file as arguments of a command line.
struct FileArguments {
    std::vector<std::string> arguments; ///< "--fps=12"
    Places places;
    std::vector<std::string> problems; ///< each with file, line and key
    bool is_parsed = true;             ///< false: the problem is the file as a whole
};

/// Describes a parse error for people.
std::string problem_text(const CLI::ParseError& error, const CLI::App& app);

/// Keys are the long names of `app`'s flags without dashes. Leaves out flags that `app` was given, because they win.
FileArguments read_config_file(const std::filesystem::path& file, const CLI::App& app);

/// "--fps 0: more than 0" -> "server.toml:3: fps 0: more than 0", if --fps was read there.
std::string with_place(const std::string& problem, const Places& places);

/// The flag's name from "--fps=12".
std::string flag_name(const std::string& argument);

/// The flag of `app` that resembles `name` ("--fsp") most; empty: none does.
std::string nearest_flag(const std::string& name, const CLI::App& app);

/// The one of `words` that resembles `word` most; empty: none does.
std::string nearest_word(const std::string& word, const std::vector<std::string>& words);

/// All values that are set or have a default, as a file for `read_config_file`.
std::string config_text(const CLI::App& app);

} // namespace fieldcast::command_line
