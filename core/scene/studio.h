// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/scene.h"

#include <cstddef>
#include <string_view>
#include <vector>

// An environment for files that bring no light: a grey room with a soft key light above the right shoulder of who looks at
// the front (+Z), a fill light on the left and a rim light behind.
namespace fieldcast::scene {

inline constexpr std::string_view kStudioExtension = ".hdr";

/// The studio as a Radiance file (RGBE, 64×32, equirectangular), as it travels in bundles. Always the same bytes.
std::vector<std::byte> studio_file();

/// The same, as it is read from that file.
Environment studio_environment();

} // namespace fieldcast::scene
