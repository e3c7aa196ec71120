// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/kernel.h"

#include "core/gpu/shader_stage.h"

#include <utility>

namespace fieldcast::gpu {

Kernel::Kernel(const Device& device, const KernelCode& code, const KernelLayout& layout,
               std::span<const Specialisation> specialisations)
    : Kernel() {
    device_ = device.handle();
    push_bytes_ = layout.push_bytes;
    layout_ = create_pipeline_layout(device, layout, VK_SHADER_STAGE_COMPUTE_BIT);

    const SpecialisationMap special(specialisations);
    const ShaderModule module(device, code);
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.layout = layout_;
    info.stage = module.stage(VK_SHADER_STAGE_COMPUTE_BIT, special);
    const VkResult result = vkCreateComputePipelines(device_, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_);
    check(result, (std::string("vkCreateComputePipelines (") + code.name + ")").c_str());
}

Kernel::~Kernel() {
    if (device_ != VK_NULL_HANDLE) {
        vkDestroyPipeline(device_, pipeline_, nullptr);
        vkDestroyPipelineLayout(device_, layout_, nullptr);
    }
}

Kernel::Kernel(Kernel&& other) noexcept : Kernel() {
    *this = std::move(other);
}

Kernel& Kernel::operator=(Kernel&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(layout_, other.layout_);
    std::swap(pipeline_, other.pipeline_);
    std::swap(push_bytes_, other.push_bytes_);
    return *this;
}

} // namespace fieldcast::gpu
