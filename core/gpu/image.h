// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"

// What all images need; for core/gpu.
namespace fieldcast::gpu {

/// A 2D array image without multisampling, tiled as the device likes best.
struct ImageDesc {
    VkFormat format = VK_FORMAT_UNDEFINED;
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    std::uint32_t layers = 1;
    std::uint32_t mips = 1;
    VkImageUsageFlags usage = 0;
};

/// Throws VulkanError where the image is larger than the device allows.
VkImage create_image(const Device& device, const ImageDesc& desc);

/// Allocates memory of the device's own, if the image can have that, and binds it. Throws VulkanError.
VkDeviceMemory allocate_and_bind(const Device& device, VkImage image);

/// Mip levels of all layers of an image, and what happens to them.
struct ImageTransition {
    VkImageLayout from = VK_IMAGE_LAYOUT_UNDEFINED;
    VkImageLayout to = VK_IMAGE_LAYOUT_UNDEFINED;
    std::uint32_t first_mip = 0;
    std::uint32_t mips = VK_REMAINING_MIP_LEVELS;
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
};

/// A full barrier: what used the image before is over when what comes after begins.
void transition(VkCommandBuffer commands, VkImage image, const ImageTransition& change);

} // namespace fieldcast::gpu
