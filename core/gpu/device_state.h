// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "core/gpu/device.h"

#include <mutex>

namespace fieldcast::gpu {

/// Functions of VK_KHR_acceleration_structure; null without `DeviceInfo::has_ray_query`.
struct AccelerationStructureFunctions {
    PFN_vkCreateAccelerationStructureKHR create = nullptr;
    PFN_vkDestroyAccelerationStructureKHR destroy = nullptr;
    PFN_vkGetAccelerationStructureBuildSizesKHR build_sizes = nullptr;
    PFN_vkCmdBuildAccelerationStructuresKHR build = nullptr;
    PFN_vkGetAccelerationStructureDeviceAddressKHR address = nullptr;
};

struct ValidationMessages {
    std::uint32_t count = 0;
    std::vector<std::string> texts;
};

/// What a Device owns. Handles are destroyed in reverse order of creation, also after a failed constructor.
struct Device::State {
    State() = default;
    ~State();
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    VkInstance instance = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;
    DeviceInfo info;
    VkPhysicalDeviceMemoryProperties memory{};
    AccelerationStructureFunctions acceleration;
    std::uint64_t scratch_alignment = 1; ///< of acceleration structure builds, bytes
    mutable std::mutex queue_mutex;      ///< held while submitting, not while waiting
    mutable Guarded<ValidationMessages> validation;
};

} // namespace fieldcast::gpu
