// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/vulkan_error.h"

#include <string>

namespace fieldcast::gpu {
namespace {

std::string result_text(VkResult result) {
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "out of host memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "out of device memory";
    case VK_ERROR_DEVICE_LOST:
        return "device lost";
    case VK_ERROR_INITIALIZATION_FAILED:
        return "initialisation failed";
    case VK_ERROR_TOO_MANY_OBJECTS:
        return "too many objects (memory allocations are limited by the driver)";
    case VK_ERROR_FORMAT_NOT_SUPPORTED:
        return "format not supported";
    default:
        return "VkResult " + std::to_string(result);
    }
}

} // namespace

void check(VkResult result, const char* call) {
    if (result < 0) {
        throw VulkanError(std::string(call) + ": " + result_text(result));
    }
}

} // namespace fieldcast::gpu
