// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/buffer.h"

namespace fieldcast::gpu {

/// Size and format of a texture.
struct TextureDesc {
    std::uint32_t width_px = 1;
    std::uint32_t height_px = 1;
    std::uint32_t layers = 1;
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    bool mip_maps = true; ///< all mip levels, made on the device from level 0
};

/// A sampled 2D array image with a linear sampler (repeat, trilinear). Shaders implement the other wrap modes.
class Texture {
public:
    Texture() = default;
    /// Uploads `layer_bytes` and makes mip maps. One span per layer, each of width·height·texel bytes, tightly packed.
    /// Blocks. Throws VulkanError, also if the device cannot filter the format.
    Texture(const Device& device, const TextureDesc& desc, std::span<const std::span<const std::byte>> layer_bytes);
    ~Texture();
    Texture(Texture&& other) noexcept;
    Texture& operator=(Texture&& other) noexcept;

    VkImageView view() const { return view_; }
    VkSampler sampler() const { return sampler_; }

private:
    void release() noexcept;

    VkDevice device_ = VK_NULL_HANDLE;
    VkImage image_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkImageView view_ = VK_NULL_HANDLE;
    VkSampler sampler_ = VK_NULL_HANDLE;
};

} // namespace fieldcast::gpu
