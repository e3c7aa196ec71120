// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/scenario.h"

#include <filesystem>
#include <optional>
#include <string>

namespace fieldcast::client {

/// What the command line of fieldcast-load asks for.
struct LoadOptions {
    load::Scenario scenario;
    std::filesystem::path json; ///< empty: no file
    std::filesystem::path html; ///< empty: no file
    std::filesystem::path hgrm; ///< folder; empty: no files
    bool is_check = false;      ///< only validate
    bool is_quiet = false;
    bool is_verbose = false;
};

struct LoadInvocation {
    std::optional<LoadOptions> options; ///< empty: print `text` and exit with `exit_code`
    std::string text;
    int exit_code = 0;
};

/// Reads the command line, the scenario file that it names, and FIELDCAST_TOKEN. Flags win over the file.
LoadInvocation read_load_options(int argc, const char* const* argv);

} // namespace fieldcast::client
