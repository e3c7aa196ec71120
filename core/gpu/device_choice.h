// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device_info.h"

#include <cstdint>
#include <vector>

namespace fieldcast::gpu {

/// A physical device, its queue family and its properties.
struct DeviceChoice {
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;
    DeviceInfo info;
};

/// The best device with all required features. Throws NoDeviceError, whose message lists what each device lacks, and
/// VulkanError.
DeviceChoice choose_device(VkInstance instance, const DeviceOptions& options);

/// Extensions that ray queries need (`DeviceInfo::has_ray_query`).
const std::vector<const char*>& ray_query_extensions();

} // namespace fieldcast::gpu
