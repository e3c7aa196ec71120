// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/bindings.h"
#include "core/gpu/kernel_code.h"

#include <initializer_list>

namespace fieldcast::gpu {

/// A compute pipeline made from a kernel.
class Kernel {
public:
    Kernel() = default;
    /// `layout.sets` are needed only during the call. Throws VulkanError, which names the kernel.
    Kernel(const Device& device, const KernelCode& code, const KernelLayout& layout,
           std::span<const Specialisation> specialisations = {});
    ~Kernel();
    Kernel(Kernel&& other) noexcept;
    Kernel& operator=(Kernel&& other) noexcept;

    VkPipeline pipeline() const { return pipeline_; }
    VkPipelineLayout layout() const { return layout_; }
    std::uint32_t push_bytes() const { return push_bytes_; }

private:
    VkDevice device_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
    std::uint32_t push_bytes_ = 0;
};

} // namespace fieldcast::gpu
