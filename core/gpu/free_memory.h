// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"

namespace fieldcast::gpu {

/// How many bytes could be allocated on the device now. On a CPU: what the machine and our control group have left.
/// Elsewhere: what the driver says of the largest heap of its own, or that heap's size if it says nothing.
std::uint64_t free_memory_bytes(const Device& device);

} // namespace fieldcast::gpu
