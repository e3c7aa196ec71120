// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/gltf/document.h"
#include "core/scene/scene.h"

#include <vector>

namespace fieldcast::scene {

/// Materials and the textures they use. Other textures are dropped. `Texture::image` is still an index of the file's
/// images.
struct GltfSurfaces {
    std::vector<Texture> textures;
    std::vector<Material> materials; ///< those of the file, then the default material
};

GltfSurfaces read_surfaces(GltfDocument& document);

} // namespace fieldcast::scene
