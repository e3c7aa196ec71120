// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/play/playback.h"

#include <filesystem>
#include <optional>
#include <string>

namespace fieldcast::client {

/// The checked command line of fieldcast-client.
struct Options {
    play::PlayOptions play;
    bool falls_back_to_views = false; ///< --mode scene,views: request finished views if there is no Vulkan device
    std::filesystem::path json;       ///< empty: no file
    bool is_verbose = false;
};

/// Either options to run with, or a text to print.
struct Invocation {
    std::optional<Options> options; ///< empty: print `text` and exit with `exit_code`
    std::string text;
    int exit_code = 0;
};

/// Reads the command line, the file named by --steer and the environment variable FIELDCAST_TOKEN. Problems are in the
/// result; nothing is thrown for them.
Invocation read_options(int argc, const char* const* argv);

} // namespace fieldcast::client
