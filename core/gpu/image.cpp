// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/image.h"

#include "core/base/error.h"

#include <algorithm>

namespace fieldcast::gpu {

namespace {

void require_size(const Device& device, const ImageDesc& desc) {
    const DeviceInfo& info = device.info();
    if (std::max(desc.width_px, desc.height_px) > info.max_image_side || desc.layers > info.max_image_layers) {
        throw VulkanError("vkCreateImage: " + std::to_string(desc.width_px) + "x" + std::to_string(desc.height_px) +
                          " with " + std::to_string(desc.layers) + " layers is more than " + info.name + " allows (" +
                          std::to_string(info.max_image_side) + ", " + std::to_string(info.max_image_layers) + ")");
    }
}

} // namespace

VkImage create_image(const Device& device, const ImageDesc& desc) {
    require_size(device, desc);
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = desc.format;
    info.extent = {desc.width_px, desc.height_px, 1};
    info.mipLevels = desc.mips;
    info.arrayLayers = desc.layers;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = desc.usage;
    VkImage image = VK_NULL_HANDLE;
    check(vkCreateImage(device.handle(), &info, nullptr, &image), "vkCreateImage");
    return image;
}

VkDeviceMemory allocate_and_bind(const Device& device, VkImage image) {
    VkMemoryRequirements requirements{};
    vkGetImageMemoryRequirements(device.handle(), image, &requirements);
    const auto local = device.memory_type(requirements.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = requirements.size;
    info.memoryTypeIndex = local ? *local : device.memory_type(requirements.memoryTypeBits, 0).value();
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check(vkAllocateMemory(device.handle(), &info, nullptr, &memory), "vkAllocateMemory");
    const VkResult bound = vkBindImageMemory(device.handle(), image, memory, 0);
    if (bound != VK_SUCCESS) {
        vkFreeMemory(device.handle(), memory, nullptr);
    }
    check(bound, "vkBindImageMemory");
    return memory;
}

void transition(VkCommandBuffer commands, VkImage image, const ImageTransition& change) {
    VkImageMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.oldLayout = change.from;
    barrier.newLayout = change.to;
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {change.aspect, change.first_mip, change.mips, 0, VK_REMAINING_ARRAY_LAYERS};
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

} // namespace fieldcast::gpu
