// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"

namespace fieldcast::gpu {

/// A physical device and how to use it.
struct DeviceChoice {
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;
    DeviceInfo info;
};

/// The best device that has everything required. Throws NoDeviceError, which lists what each device lacks.
DeviceChoice choose_device(VkInstance instance, const DeviceOptions& options);

/// Extensions that make `DeviceInfo::has_ray_query` true.
const std::vector<const char*>& ray_query_extensions();

} // namespace fieldcast::gpu
