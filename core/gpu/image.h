// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"

// Images and their memory; for core/gpu.
namespace fieldcast::gpu {

/// A 2D array image without multisampling, in the optimal tiling of the device.
struct ImageDesc {
    VkFormat format = VK_FORMAT_UNDEFINED;
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    std::uint32_t layers = 1;
    std::uint32_t mips = 1;
    VkImageUsageFlags usage = 0;
};

/// The caller destroys the image. Throws VulkanError if the image is larger than the device allows.
VkImage create_image(const Device& device, const ImageDesc& desc);

/// Allocates memory for the image and binds it; device-local memory where the image may have it. The caller frees the
/// memory. Throws VulkanError.
VkDeviceMemory allocate_and_bind(const Device& device, VkImage image);

/// Change of layout of some mip levels of an image, in all its layers.
struct ImageTransition {
    VkImageLayout from = VK_IMAGE_LAYOUT_UNDEFINED;
    VkImageLayout to = VK_IMAGE_LAYOUT_UNDEFINED;
    std::uint32_t first_mip = 0;
    std::uint32_t mips = VK_REMAINING_MIP_LEVELS;
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
};

/// Records a layout change and a full barrier: later commands start when all earlier ones have finished.
void transition(VkCommandBuffer commands, VkImage image, const ImageTransition& change);

} // namespace fieldcast::gpu
