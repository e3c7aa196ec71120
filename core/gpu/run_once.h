// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"

#include <functional>

namespace fieldcast::gpu {

/// Records commands into a command buffer that the device keeps for reuse, submits them and waits. Later
/// submissions and the host see all that they wrote. Thread-safe. Throws VulkanError.
void run_once(const Device& device, const std::function<void(VkCommandBuffer)>& record);

} // namespace fieldcast::gpu
