// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vulkan/vulkan.h>

namespace fieldcast::gpu {

/// Bytes of one texel. Fails an assertion for formats that Fieldcast does not use.
std::uint32_t texel_bytes(VkFormat format);

} // namespace fieldcast::gpu
