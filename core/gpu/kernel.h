// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/bindings.h"

#include <initializer_list>

namespace fieldcast::gpu {

/// A compiled kernel, embedded in the binary.
struct KernelCode {
    const char* name = "";
    std::span<const std::uint32_t> spirv;
};

/// Value of a specialisation constant (bool: 0 or 1; float: its bits through `std::bit_cast`).
struct Specialisation {
    std::uint32_t id = 0;
    std::uint32_t value = 0;
};

struct KernelLayout {
    std::vector<const BindingLayout*> sets; ///< set 0, 1, …
    std::uint32_t push_bytes = 0;           ///< ≤ 128
};

/// A compute pipeline.
class Kernel {
public:
    Kernel() = default;
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
