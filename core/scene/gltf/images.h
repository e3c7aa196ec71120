// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/gltf/buffer_views.h"
#include "core/scene/scene.h"

#include <vector>

namespace fieldcast::scene {

/// Decodes the images that `textures` use, several at a time. Renumbers `Texture::image` to index the result.
/// Throws UserError.
std::vector<Image> decode_images(const GltfDocument& document, GltfBufferViews& views, const SceneLimits& limits,
                                 std::vector<Texture>& textures);

} // namespace fieldcast::scene
