// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/texture.h"
#include "core/scene/scene.h"
#include "shaders/shared/scene.h"

#include <array>

namespace fieldcast::scene {

/// Location of a texture: the array of its size class and colour space, and the layer in it.
struct TexturePlace {
    std::uint32_t array = 0;
    std::uint32_t layer = 0;
    std::uint32_t side_px = 1;
};

/// All images of a scene in at most kTextureArrays square 2D arrays, so that no kernel needs descriptor indexing.
/// Arrays 0 … 3 are sRGB, 4 … 7 linear. Images that do not have the size of a class are resampled to a larger one.
class TextureArrays {
public:
    /// Throws UserError if an image exceeds the device's limits.
    TextureArrays(const gpu::Device& device, const Scene& scene);

    /// Place of the image of Scene::textures[texture] when it is used as sRGB (colour) or linear data.
    TexturePlace place(std::uint32_t texture, bool srgb) const;
    const gpu::Texture& array(std::uint32_t index) const { return arrays_[index]; }
    std::uint32_t used_mask() const { return used_mask_; } ///< bit k: array k holds images
    std::uint64_t device_bytes() const { return device_bytes_; }

private:
    void plan(const Scene& scene, bool srgb);
    void upload(const gpu::Device& device, const Scene& scene, std::uint32_t array);

    const Scene& scene_;
    std::array<std::vector<std::uint32_t>, shared::kTextureArrays> images_; ///< per array: image of each layer
    std::array<std::uint32_t, shared::kTextureArrays> sides_{};
    std::array<std::vector<TexturePlace>, 2> places_; ///< [srgb][image]
    std::array<gpu::Texture, shared::kTextureArrays> arrays_;
    std::uint32_t used_mask_ = 0;
    std::uint64_t device_bytes_ = 0;
};

} // namespace fieldcast::scene
