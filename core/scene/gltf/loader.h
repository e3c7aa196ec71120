// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/load_options.h"
#include "core/scene/scene.h"

namespace fieldcast::scene {

/// Loads a .gltf or .glb file with everything it refers to.
/// Throws UserError with file, object and reason ("lamp.gltf: accessor 12: ends 900 bytes beyond bufferView 3").
Scene load_scene(const std::filesystem::path& file, const LoadOptions& options = {});

} // namespace fieldcast::scene
