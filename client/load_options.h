// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/scenario.h"

#include <filesystem>
#include <optional>
#include <string>

namespace fieldcast::client {

/// The checked command line of fieldcast-load.
struct LoadOptions {
    load::Scenario scenario;
    std::filesystem::path json; ///< empty: no file
    std::filesystem::path html; ///< empty: no file
    std::filesystem::path hgrm; ///< folder; empty: no files
    bool is_check = false;      ///< only validate, do not run
    bool is_quiet = false;
    bool is_verbose = false;
};

/// Either options to run with, or a text to print.
struct LoadInvocation {
    std::optional<LoadOptions> options; ///< empty: print `text` and exit with `exit_code`
    std::string text;
    int exit_code = 0;
};

/// Reads the command line, the scenario file that it names, and the environment variable FIELDCAST_TOKEN. Flags
/// override the file. Problems are in the result; nothing is thrown for them.
LoadInvocation read_load_options(int argc, const char* const* argv);

} // namespace fieldcast::client
