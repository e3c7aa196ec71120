// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/scene.h"

#include <cstddef>
#include <string_view>
#include <vector>

// An environment for files that bring no light: a grey room. A soft key light stands at the right of the front (+Z), a fill
// light at the left, a rim light behind.
namespace fieldcast::scene {

inline constexpr std::string_view kStudioExtension = ".hdr";

/// Whether anything in the file gives light: a lamp, or a material that emits.
bool has_light(const Scene& scene);

/// The studio as a Radiance file (RGBE, 64×32, equirectangular), as it travels in bundles. Always the same bytes.
std::vector<std::byte> studio_file();

/// The same, as it is read from that file.
Environment studio_environment();

} // namespace fieldcast::scene
