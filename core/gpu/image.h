// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"

// What all images need; for core/gpu.
namespace fieldcast::gpu {

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
