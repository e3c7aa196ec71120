// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <vulkan/vulkan.h>

namespace fieldcast::gpu {

/// A Vulkan call failed; the message names the call and the result.
class VulkanError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// There is no usable Vulkan device; the message lists the devices found and what each of them lacks.
class NoDeviceError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Throws VulkanError if `result` is an error code. `call` is the name of the Vulkan function.
void check(VkResult result, const char* call);

} // namespace fieldcast::gpu
