// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/device.h"

#include "core/gpu/device_choice.h"
#include "core/gpu/device_state.h"
#include "core/gpu/instance.h"

#include <limits>

namespace fieldcast::gpu {
namespace {

/// Chain of feature structs for vkCreateDevice. Not copyable: its members point to each other.
struct FeatureChain {
    VkPhysicalDeviceFeatures2 features{};
    VkPhysicalDeviceVulkan12Features v12{};
    VkPhysicalDeviceVulkan13Features v13{};
    VkPhysicalDeviceAccelerationStructureFeaturesKHR acceleration{};
    VkPhysicalDeviceRayQueryFeaturesKHR ray_query{};

    FeatureChain(bool with_ray_query, bool with_rasteriser) {
        features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
        features.pNext = &v12;
        features.features.shaderInt64 = VK_TRUE;
        features.features.independentBlend = with_rasteriser ? VK_TRUE : VK_FALSE;
        v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
        v12.pNext = &v13;
        v12.scalarBlockLayout = VK_TRUE;
        v12.bufferDeviceAddress = VK_TRUE;
        v12.hostQueryReset = VK_TRUE;
        v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
        v13.pNext = with_ray_query ? &acceleration : nullptr;
        v13.synchronization2 = VK_TRUE;
        v13.dynamicRendering = VK_TRUE;
        v13.maintenance4 = VK_TRUE; // glslang writes specialised workgroup sizes as LocalSizeId
        acceleration.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR;
        acceleration.pNext = &ray_query;
        acceleration.accelerationStructure = VK_TRUE;
        ray_query.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR;
        ray_query.rayQuery = VK_TRUE;
    }
    FeatureChain(const FeatureChain&) = delete;
    FeatureChain& operator=(const FeatureChain&) = delete;
};

void create_device(DeviceState& state) {
    const FeatureChain chain(state.info.has_ray_query, state.info.has_rasteriser);
    const float priority = 1.0F;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = state.queue_family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &chain.features;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    if (state.info.has_ray_query) {
        info.enabledExtensionCount = static_cast<std::uint32_t>(ray_query_extensions().size());
        info.ppEnabledExtensionNames = ray_query_extensions().data();
    }
    check(vkCreateDevice(state.physical, &info, nullptr, &state.device), "vkCreateDevice");
    vkGetDeviceQueue(state.device, state.queue_family, 0, &state.queue);
}

template <class Function> void load(VkDevice device, Function& function, const char* name) {
    function = reinterpret_cast<Function>(vkGetDeviceProcAddr(device, name));
    if (function == nullptr) {
        throw VulkanError(std::string("vkGetDeviceProcAddr: the driver has no ") + name);
    }
}

void load_acceleration_structure(DeviceState& state) {
    auto& functions = state.acceleration;
    load(state.device, functions.create, "vkCreateAccelerationStructureKHR");
    load(state.device, functions.destroy, "vkDestroyAccelerationStructureKHR");
    load(state.device, functions.build_sizes, "vkGetAccelerationStructureBuildSizesKHR");
    load(state.device, functions.build, "vkCmdBuildAccelerationStructuresKHR");
    load(state.device, functions.address, "vkGetAccelerationStructureDeviceAddressKHR");

    VkPhysicalDeviceAccelerationStructurePropertiesKHR acceleration{};
    acceleration.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &acceleration;
    vkGetPhysicalDeviceProperties2(state.physical, &properties);
    state.scratch_alignment = acceleration.minAccelerationStructureScratchOffsetAlignment;
}

} // namespace

Device::Device(const DeviceOptions& options) : state_(std::make_unique<DeviceState>()) {
    create_instance(*state_, options.validation);
    const auto choice = choose_device(state_->instance, options);
    state_->physical = choice.physical;
    state_->queue_family = choice.queue_family;
    state_->info = choice.info;
    state_->map_device_memory = options.map_device_memory;
    vkGetPhysicalDeviceMemoryProperties(state_->physical, &state_->memory);
    create_device(*state_);
    if (state_->info.has_ray_query) {
        load_acceleration_structure(*state_);
    }
}

Device::~Device() = default;

const DeviceInfo& Device::info() const {
    return state_->info;
}
VkDevice Device::handle() const {
    return state_->device;
}
VkPhysicalDevice Device::physical() const {
    return state_->physical;
}
std::uint32_t Device::queue_family() const {
    return state_->queue_family;
}

std::optional<std::uint32_t> Device::memory_type(std::uint32_t type_bits, VkMemoryPropertyFlags wanted) const {
    const auto& memory = state_->memory;
    for (std::uint32_t index = 0; index < memory.memoryTypeCount; ++index) {
        const bool is_allowed = (type_bits & (1U << index)) != 0;
        if (is_allowed && (memory.memoryTypes[index].propertyFlags & wanted) == wanted) {
            return index;
        }
    }
    return std::nullopt;
}

void Device::submit_and_wait(VkCommandBuffer commands) const {
    VkFenceCreateInfo fence_info{};
    fence_info.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    VkFence fence = VK_NULL_HANDLE;
    check(vkCreateFence(state_->device, &fence_info, nullptr, &fence), "vkCreateFence");

    VkCommandBufferSubmitInfo command_info{};
    command_info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
    command_info.commandBuffer = commands;
    VkSubmitInfo2 submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &command_info;
    const char* call = "vkQueueSubmit2";
    VkResult result = VK_SUCCESS;
    {
        const std::scoped_lock lock(state_->queue_mutex);
        result = vkQueueSubmit2(state_->queue, 1, &submit, fence);
    }
    if (result == VK_SUCCESS) {
        call = "vkWaitForFences";
        result = vkWaitForFences(state_->device, 1, &fence, VK_TRUE, std::numeric_limits<std::uint64_t>::max());
    }
    vkDestroyFence(state_->device, fence, nullptr);
    check(result, call);
}

std::uint32_t Device::validation_message_count() const {
    return state_->validation.lock()->count;
}
std::vector<std::string> Device::validation_messages() const {
    return state_->validation.lock()->texts;
}

} // namespace fieldcast::gpu
