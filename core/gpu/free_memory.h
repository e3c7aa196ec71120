// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"

namespace fieldcast::gpu {

/// Bytes that can be allocated on the device now. On a CPU device: the smaller of the available main memory and what
/// the control group of this process has left. On other devices: the largest free budget of a device-local heap, as
/// reported by VK_EXT_memory_budget; the size of the heap if the driver does not report budgets.
std::uint64_t free_memory_bytes(const Device& device);

} // namespace fieldcast::gpu
