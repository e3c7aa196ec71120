// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/load_options.h"

#include <string>
#include <vector>

namespace fieldcast::scene {

/// An extension that a glTF file uses.
struct ExtensionUse {
    std::string name;
    bool is_required = false; ///< the file requires it
    bool is_read = false;     ///< the loader reads it; otherwise it is ignored with a warning
};

/// Extensions in the order of the file. Throws UserError, also for required extensions that the loader does not read.
std::vector<ExtensionUse> read_extensions(const std::filesystem::path& file, const SceneLimits& limits = {});

} // namespace fieldcast::scene
