// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/kernel.h"

#include "core/base/error.h"

#include <utility>

namespace fieldcast::gpu {
namespace {

constexpr std::uint32_t kMaxPushBytes = 128; // every Vulkan device has at least this many

VkPipelineLayout create_layout(VkDevice device, const KernelLayout& layout) {
    FC_ASSERT(layout.push_bytes <= kMaxPushBytes && layout.push_bytes % 4 == 0, "push constants: at most 128 bytes");
    std::vector<VkDescriptorSetLayout> sets;
    for (const auto* set : layout.sets) {
        sets.push_back(set->handle());
    }
    const VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, layout.push_bytes};
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = static_cast<std::uint32_t>(sets.size());
    info.pSetLayouts = sets.data();
    info.pushConstantRangeCount = layout.push_bytes > 0 ? 1 : 0;
    info.pPushConstantRanges = &push;
    VkPipelineLayout handle = VK_NULL_HANDLE;
    check(vkCreatePipelineLayout(device, &info, nullptr, &handle), "vkCreatePipelineLayout");
    return handle;
}

VkShaderModule create_module(VkDevice device, const KernelCode& code) {
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = code.spirv.size_bytes();
    info.pCode = code.spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    check(vkCreateShaderModule(device, &info, nullptr, &module), "vkCreateShaderModule");
    return module;
}

} // namespace

Kernel::Kernel(const Device& device, const KernelCode& code, const KernelLayout& layout,
               std::span<const Specialisation> specialisations)
    : Kernel() {
    device_ = device.handle();
    push_bytes_ = layout.push_bytes;
    layout_ = create_layout(device_, layout);

    std::vector<VkSpecializationMapEntry> entries;
    for (std::size_t index = 0; index < specialisations.size(); ++index) {
        const auto offset = index * sizeof(Specialisation) + offsetof(Specialisation, value);
        entries.push_back({specialisations[index].id, static_cast<std::uint32_t>(offset), sizeof(std::uint32_t)});
    }
    VkSpecializationInfo special{};
    special.mapEntryCount = static_cast<std::uint32_t>(entries.size());
    special.pMapEntries = entries.data();
    special.dataSize = specialisations.size_bytes();
    special.pData = specialisations.data();

    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.layout = layout_;
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = create_module(device_, code);
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = &special;
    const VkResult result = vkCreateComputePipelines(device_, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_);
    vkDestroyShaderModule(device_, info.stage.module, nullptr);
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
