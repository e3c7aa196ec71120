// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/guarded.h"
#include "core/gpu/device_info.h"

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace fieldcast::gpu {

/// Functions of VK_KHR_acceleration_structure; null without `DeviceInfo::has_ray_query`.
struct AccelerationStructureFunctions {
    PFN_vkCreateAccelerationStructureKHR create = nullptr;
    PFN_vkDestroyAccelerationStructureKHR destroy = nullptr;
    PFN_vkGetAccelerationStructureBuildSizesKHR build_sizes = nullptr;
    PFN_vkCmdBuildAccelerationStructuresKHR build = nullptr;
    PFN_vkGetAccelerationStructureDeviceAddressKHR address = nullptr;
};

/// Messages of the validation layer.
struct ValidationMessages {
    std::uint32_t count = 0;
    std::vector<std::string> texts; ///< oldest first, at most 64
};

/// A command pool and its only command buffer.
struct OneTimeCommands {
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
};

/// Base of objects that a device keeps for reuse. They are destroyed before the device.
struct Kept {
    Kept() = default;
    virtual ~Kept() = default;
    Kept(const Kept&) = delete;
    Kept& operator=(const Kept&) = delete;
};

/// Objects of one kind that no call uses now. A call takes one out, uses it without the lock, and puts it back.
template <class T> using IdleObjects = Guarded<std::vector<T>>;

/// Handles and extension functions of a Device, for core/gpu. Handles are destroyed in reverse order of creation, also
/// after a failed constructor.
struct DeviceState {
    DeviceState() = default;
    ~DeviceState();
    DeviceState(const DeviceState&) = delete;
    DeviceState& operator=(const DeviceState&) = delete;

    VkInstance instance = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;
    DeviceInfo info;
    VkPhysicalDeviceMemoryProperties memory{};
    bool map_device_memory = true; ///< DeviceOptions::map_device_memory
    AccelerationStructureFunctions acceleration;
    std::uint64_t scratch_alignment = 1; ///< of acceleration structure builds, bytes
    mutable std::mutex queue_mutex;      ///< held while submitting, not while waiting
    mutable Guarded<ValidationMessages> validation;
    mutable IdleObjects<OneTimeCommands> idle_commands;                ///< of run_once()
    mutable IdleObjects<std::unique_ptr<Kept>> idle_upload_buffers;   ///< of write_buffer()
    mutable IdleObjects<std::unique_ptr<Kept>> idle_readback_buffers; ///< of read_buffer()
};

} // namespace fieldcast::gpu
