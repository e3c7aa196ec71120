// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/bindings.h"
#include "core/gpu/kernel_code.h"

// Parts of compute and graphics pipelines; for core/gpu.
namespace fieldcast::gpu {

/// Creates the layout of a pipeline whose shaders of `stages` share sets and push constants. The caller destroys it.
/// Throws VulkanError.
VkPipelineLayout create_pipeline_layout(const Device& device, const KernelLayout& layout, VkShaderStageFlags stages);

/// Values of specialisation constants in the form of Vulkan. `values` must outlive it. Not copyable: it points into
/// itself.
class SpecialisationMap {
public:
    explicit SpecialisationMap(std::span<const Specialisation> values);
    SpecialisationMap(const SpecialisationMap&) = delete;
    SpecialisationMap& operator=(const SpecialisationMap&) = delete;

    const VkSpecializationInfo& info() const { return info_; }

private:
    std::vector<VkSpecializationMapEntry> entries_;
    VkSpecializationInfo info_{};
};

/// A kernel loaded by the driver; may be destroyed once its pipelines exist.
class ShaderModule {
public:
    ShaderModule(const Device& device, const KernelCode& code);
    ~ShaderModule();
    ShaderModule(const ShaderModule&) = delete;
    ShaderModule& operator=(const ShaderModule&) = delete;

    /// Description of one stage of a pipeline. The module and `values` must outlive it.
    VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits stage, const SpecialisationMap& values) const;

private:
    VkDevice device_;
    VkShaderModule module_ = VK_NULL_HANDLE;
};

} // namespace fieldcast::gpu
