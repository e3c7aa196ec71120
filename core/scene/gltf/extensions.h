// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/load_options.h"

#include <string>
#include <vector>

namespace fieldcast::scene {

/// An extension that a glTF file uses.
struct ExtensionUse {
    std::string name;
    bool is_required = false; ///< by the file
    bool is_read = false;     ///< by the loader; else what it says is left out, with a warning
};

/// In the order of the file. Throws UserError, also for required extensions that the loader does not read.
std::vector<ExtensionUse> read_extensions(const std::filesystem::path& file, const SceneLimits& limits = {});

} // namespace fieldcast::scene
