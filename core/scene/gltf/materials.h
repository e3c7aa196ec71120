// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/gltf/document.h"
#include "core/scene/scene.h"

#include <vector>

namespace fieldcast::scene {

/// Textures and materials. Only textures that a material uses are kept; `Texture::image` still counts the file's
/// images.
struct GltfSurfaces {
    std::vector<Texture> textures;
    std::vector<Material> materials; ///< as in the file, then a default one
};

GltfSurfaces read_surfaces(GltfDocument& document);

} // namespace fieldcast::scene
