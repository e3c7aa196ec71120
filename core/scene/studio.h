// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/scene.h"

#include <cstddef>
#include <string_view>
#include <vector>

// An environment for files without light: a grey room. It has a soft key light at the right of the front (+Z), a fill
// light at the left, and a rim light behind.
namespace fieldcast::scene {

inline constexpr std::string_view kStudioExtension = ".hdr";

/// Whether the scene has a punctual light or an emissive material.
bool has_light(const Scene& scene);

/// The studio as a Radiance file (RGBE, 64×32, equirectangular), as bundles contain it. The bytes are always the same.
std::vector<std::byte> studio_file();

/// The studio as decoded from that file, bit for bit.
Environment studio_environment();

} // namespace fieldcast::scene
