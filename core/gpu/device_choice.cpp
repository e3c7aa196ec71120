// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/device_choice.h"

#include "core/gpu/vulkan_error.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <optional>
#include <span>
#include <utility>

namespace fieldcast::gpu {
namespace {

constexpr const char* kInstallHint = "; install a Vulkan 1.3 driver, e.g. the software driver in mesa-vulkan-drivers";

std::string lower(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

void append_hex(std::string& text, std::span<const std::uint8_t> bytes) {
    constexpr const char* kDigits = "0123456789abcdef";
    for (const auto byte : bytes) {
        text += kDigits[byte >> 4U];
        text += kDigits[byte & 15U];
    }
}

std::uint64_t largest_heap(VkPhysicalDevice physical) {
    VkPhysicalDeviceMemoryProperties memory{};
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    std::uint64_t bytes = 0;
    for (const VkMemoryHeap& heap : std::span(memory.memoryHeaps, memory.memoryHeapCount)) {
        const bool is_own = (heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0;
        bytes = std::max(bytes, is_own ? std::uint64_t{heap.size} : 0);
    }
    return bytes;
}

/// First queue family for compute and graphics; vkCmdBlitImage, which makes mip maps, needs graphics.
std::optional<std::uint32_t> find_queue_family(VkPhysicalDevice physical) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    constexpr VkQueueFlags kWanted = VK_QUEUE_COMPUTE_BIT | VK_QUEUE_GRAPHICS_BIT;
    const auto found =
        std::ranges::find_if(families, [](const auto& f) { return (f.queueFlags & kWanted) == kWanted; });
    if (found == families.end()) {
        return std::nullopt;
    }
    return static_cast<std::uint32_t>(found - families.begin());
}

bool has_extensions(VkPhysicalDevice physical, std::span<const char* const> names) {
    std::uint32_t count = 0;
    check(vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr),
          "vkEnumerateDeviceExtensionProperties");
    std::vector<VkExtensionProperties> found(count);
    check(vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, found.data()),
          "vkEnumerateDeviceExtensionProperties");
    return std::ranges::all_of(names, [&](const char* name) {
        return std::ranges::any_of(found, [&](const auto& e) { return std::strcmp(e.extensionName, name) == 0; });
    });
}

bool supports_ray_query(VkPhysicalDevice physical) {
    if (!has_extensions(physical, ray_query_extensions())) {
        return false;
    }
    VkPhysicalDeviceRayQueryFeaturesKHR ray_query{};
    ray_query.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR;
    VkPhysicalDeviceAccelerationStructureFeaturesKHR acceleration{};
    acceleration.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR;
    acceleration.pNext = &ray_query;
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &acceleration;
    vkGetPhysicalDeviceFeatures2(physical, &features);
    return ray_query.rayQuery == VK_TRUE && acceleration.accelerationStructure == VK_TRUE;
}

/// Names of the required features that a Vulkan 1.3 device lacks, separated by commas.
std::string missing_features(VkPhysicalDevice physical) {
    VkPhysicalDeviceVulkan13Features v13{};
    v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    VkPhysicalDeviceVulkan12Features v12{};
    v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    v12.pNext = &v13;
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &v12;
    vkGetPhysicalDeviceFeatures2(physical, &features);
    const std::pair<const char*, VkBool32> wanted[] = {
        {"scalarBlockLayout", v12.scalarBlockLayout},
        {"bufferDeviceAddress", v12.bufferDeviceAddress},
        {"shaderInt64", features.features.shaderInt64},
        {"synchronization2", v13.synchronization2},
        {"hostQueryReset", v12.hostQueryReset},
        {"maintenance4", v13.maintenance4},
        {"a queue for compute and graphics", find_queue_family(physical).has_value() ? VK_TRUE : VK_FALSE}};
    std::string missing;
    for (const auto& [name, present] : wanted) {
        if (present == VK_FALSE) {
            missing += (missing.empty() ? "" : ", ") + std::string(name);
        }
    }
    return missing;
}

std::string version_text(std::uint32_t version) {
    std::string text = std::to_string(VK_API_VERSION_MAJOR(version));
    text.append(".").append(std::to_string(VK_API_VERSION_MINOR(version)));
    return text;
}

/// Reason why the device is not used; empty if it can be used.
std::string reason_against(VkPhysicalDevice physical, const VkPhysicalDeviceProperties& properties,
                           const DeviceOptions& options) {
    if (lower(properties.deviceName).find(lower(options.name_contains)) == std::string::npos) {
        return "its name does not contain '" + options.name_contains + "'";
    }
    if (properties.apiVersion < VK_API_VERSION_1_3) {
        return "has only Vulkan " + version_text(properties.apiVersion);
    }
    const auto missing = missing_features(physical);
    return missing.empty() ? "" : "lacks " + missing;
}

int preference(VkPhysicalDeviceType type) {
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return 4;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return 3;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return 1;
    default:
        return 0;
    }
}

/// Vulkan does not require 32-bit float depth buffers, nor pipelines that write only some of a target's images
/// (independentBlend). Almost every device has both.
bool supports_rasteriser(VkPhysicalDevice physical) {
    VkPhysicalDeviceFeatures features{};
    vkGetPhysicalDeviceFeatures(physical, &features);
    VkFormatProperties depth{};
    vkGetPhysicalDeviceFormatProperties(physical, VK_FORMAT_D32_SFLOAT, &depth);
    return features.independentBlend == VK_TRUE &&
           (depth.optimalTilingFeatures & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT) != 0;
}

DeviceInfo describe(VkPhysicalDevice physical, std::uint32_t queue_family) {
    VkPhysicalDeviceVulkan12Properties v12{};
    v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES;
    VkPhysicalDeviceVulkan11Properties v11{};
    v11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES;
    v11.pNext = &v12;
    VkPhysicalDeviceProperties2 properties2{};
    properties2.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties2.pNext = &v11;
    vkGetPhysicalDeviceProperties2(physical, &properties2);
    const auto& properties = properties2.properties;

    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());

    DeviceInfo info;
    info.name = properties.deviceName;
    info.driver = std::string(v12.driverName) + " " + v12.driverInfo;
    append_hex(info.uuid_hex, v11.deviceUUID);
    info.uuid_hex.append("-").append(std::to_string(properties.driverVersion));
    info.is_cpu = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    info.has_rasteriser = supports_rasteriser(physical);
    info.timestamp_period_ns = properties.limits.timestampPeriod;
    info.timestamp_bits = families[queue_family].timestampValidBits;
    info.max_texel_buffer_elements = properties.limits.maxTexelBufferElements;
    info.memory_bytes = largest_heap(physical);
    info.max_image_side = properties.limits.maxImageDimension2D;
    info.max_image_layers = properties.limits.maxImageArrayLayers;
    info.limits = properties.limits;
    return info;
}

} // namespace

const std::vector<const char*>& ray_query_extensions() {
    static const std::vector<const char*> kNames = {VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                                                    VK_KHR_RAY_QUERY_EXTENSION_NAME,
                                                    VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};
    return kNames;
}

DeviceChoice choose_device(VkInstance instance, const DeviceOptions& options) {
    std::uint32_t count = 0;
    check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
    std::vector<VkPhysicalDevice> devices(count);
    check(vkEnumeratePhysicalDevices(instance, &count, devices.data()), "vkEnumeratePhysicalDevices");

    DeviceChoice best;
    int best_preference = -1;
    std::string rejected;
    for (const auto physical : devices) {
        VkPhysicalDeviceProperties properties{};
        vkGetPhysicalDeviceProperties(physical, &properties);
        const auto reason = reason_against(physical, properties, options);
        if (!reason.empty()) {
            rejected += std::string(rejected.empty() ? "" : "; ") + properties.deviceName + ": " + reason;
        } else if (preference(properties.deviceType) > best_preference) {
            best.physical = physical;
            best_preference = preference(properties.deviceType);
        }
    }
    if (best.physical == VK_NULL_HANDLE) {
        throw NoDeviceError("no usable Vulkan device: " + (rejected.empty() ? "none found" : rejected) + kInstallHint);
    }
    best.queue_family = find_queue_family(best.physical).value();
    best.info = describe(best.physical, best.queue_family);
    best.info.has_ray_query = options.allow_ray_query && supports_ray_query(best.physical);
    return best;
}

} // namespace fieldcast::gpu
