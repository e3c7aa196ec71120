// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"

#include <functional>

namespace fieldcast::gpu {

/// Records commands into a temporary command buffer, submits them and waits.
void run_once(const Device& device, const std::function<void(VkCommandBuffer)>& record);

} // namespace fieldcast::gpu
