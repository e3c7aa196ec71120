// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/kernel.h"

// What compute and graphics pipelines are made of; for core/gpu.
namespace fieldcast::gpu {

/// Sets and push constants of the shaders of `stages`.
VkPipelineLayout create_pipeline_layout(const Device& device, const KernelLayout& layout, VkShaderStageFlags stages);

/// Values of specialisation constants as Vulkan takes them. `values` must outlive it. Not copyable: it points into
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

/// Needed until its pipelines are made.
class ShaderModule {
public:
    ShaderModule(const Device& device, const KernelCode& code);
    ~ShaderModule();
    ShaderModule(const ShaderModule&) = delete;
    ShaderModule& operator=(const ShaderModule&) = delete;

    /// `values` must outlive what it returns.
    VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits stage, const SpecialisationMap& values) const;

private:
    VkDevice device_;
    VkShaderModule module_ = VK_NULL_HANDLE;
};

} // namespace fieldcast::gpu
