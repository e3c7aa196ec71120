// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"

#include <cstdint>
#include <string>

namespace fieldcast::scene {

/// How rays are traced: our own BVH in texel buffers, or VK_KHR_ray_query.
enum class Traversal : std::uint8_t { kBvh, kRayQuery };

/// Reads "bvh" | "rayquery" | "auto": ray query where the device has it and is not a CPU (docs/decisions/0007). Throws
/// UserError if the device does not support the traversal `asked` for.
Traversal choose_traversal(const gpu::Device& device, const std::string& asked);

} // namespace fieldcast::scene
