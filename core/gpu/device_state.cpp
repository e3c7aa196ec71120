// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/device_state.h"

namespace fieldcast::gpu {

DeviceState::~DeviceState() {
    idle_upload_buffers.lock()->clear();
    idle_readback_buffers.lock()->clear();
    auto idle = idle_commands.lock();
    for (const OneTimeCommands& commands : *idle) {
        vkDestroyCommandPool(device, commands.pool, nullptr);
    }
    if (device != VK_NULL_HANDLE) {
        vkDestroyDevice(device, nullptr);
    }
    if (messenger != VK_NULL_HANDLE) {
        const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(instance, messenger, nullptr);
    }
    if (instance != VK_NULL_HANDLE) {
        vkDestroyInstance(instance, nullptr);
    }
}

} // namespace fieldcast::gpu
