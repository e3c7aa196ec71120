// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vulkan/vulkan.h>

namespace fieldcast::gpu {

/// Which device is opened, and how.
struct DeviceOptions {
    std::string name_contains{}; ///< picks the first device whose name contains this (case-insensitive); empty: best
    bool validation = false;       ///< VK_LAYER_KHRONOS_validation; messages are counted and logged
    bool allow_ray_query = true;   ///< false: the device is created without ray tracing extensions
    bool map_device_memory = true; ///< false, for tests: Memory::kDevice is treated as not host-visible
};

/// Properties of an opened device.
struct DeviceInfo {
    std::string name;            ///< "llvmpipe (LLVM 15.0.6, 256 bits)"
    std::string driver;          ///< "llvmpipe Mesa 25.0.7"
    std::string uuid_hex;        ///< device UUID and driver version; identifies a device with its driver
    bool is_cpu = false;         ///< a software implementation
    bool has_ray_query = false;  ///< ray queries are enabled on this device
    bool has_rasteriser = false; ///< RasterPass works on this device
    float timestamp_period_ns = 1.0F;
    std::uint32_t timestamp_bits = 64; ///< valid bits of a timestamp; 0: there are no timestamps
    std::uint32_t max_texel_buffer_elements = 0;
    std::uint64_t memory_bytes = 0;   ///< size of the largest device-local heap
    std::uint32_t max_image_side = 0; ///< pixels
    std::uint32_t max_image_layers = 0;
    VkPhysicalDeviceLimits limits{};
};

} // namespace fieldcast::gpu
