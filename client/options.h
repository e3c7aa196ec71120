// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/play/playback.h"

#include <filesystem>
#include <optional>
#include <string>

namespace fieldcast::client {

/// What the command line asks for.
struct Options {
    play::PlayOptions play;
    bool falls_back_to_views = false; ///< --mode scene,views: without a Vulkan device take finished views
    std::filesystem::path json;       ///< empty: no file
    bool is_verbose = false;
};

struct Invocation {
    std::optional<Options> options; ///< empty: print `text` and exit with `exit_code`
    std::string text;
    int exit_code = 0;
};

/// Reads the command line and FIELDCAST_TOKEN. Touches nothing else.
Invocation read_options(int argc, const char* const* argv);

} // namespace fieldcast::client
