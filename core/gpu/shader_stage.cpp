// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/shader_stage.h"

#include "core/base/error.h"

namespace fieldcast::gpu {
namespace {

constexpr std::uint32_t kMaxPushBytes = 128; // every Vulkan device has at least this many

} // namespace

VkPipelineLayout create_pipeline_layout(const Device& device, const KernelLayout& layout, VkShaderStageFlags stages) {
    FC_ASSERT(layout.push_bytes <= kMaxPushBytes && layout.push_bytes % 4 == 0, "push constants: at most 128 bytes");
    std::vector<VkDescriptorSetLayout> sets;
    for (const auto* set : layout.sets) {
        sets.push_back(set->handle());
    }
    const VkPushConstantRange push = {stages, 0, layout.push_bytes};
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = static_cast<std::uint32_t>(sets.size());
    info.pSetLayouts = sets.data();
    info.pushConstantRangeCount = layout.push_bytes > 0 ? 1 : 0;
    info.pPushConstantRanges = &push;
    VkPipelineLayout handle = VK_NULL_HANDLE;
    check(vkCreatePipelineLayout(device.handle(), &info, nullptr, &handle), "vkCreatePipelineLayout");
    return handle;
}

SpecialisationMap::SpecialisationMap(std::span<const Specialisation> values) {
    for (std::size_t index = 0; index < values.size(); ++index) {
        const auto offset = index * sizeof(Specialisation) + offsetof(Specialisation, value);
        entries_.push_back({values[index].id, static_cast<std::uint32_t>(offset), sizeof(std::uint32_t)});
    }
    info_.mapEntryCount = static_cast<std::uint32_t>(entries_.size());
    info_.pMapEntries = entries_.data();
    info_.dataSize = values.size_bytes();
    info_.pData = values.data();
}

ShaderModule::ShaderModule(const Device& device, const KernelCode& code) : device_(device.handle()) {
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = code.spirv.size_bytes();
    info.pCode = code.spirv.data();
    check(vkCreateShaderModule(device_, &info, nullptr, &module_), "vkCreateShaderModule");
}

ShaderModule::~ShaderModule() {
    vkDestroyShaderModule(device_, module_, nullptr);
}

VkPipelineShaderStageCreateInfo ShaderModule::stage(VkShaderStageFlagBits stage,
                                                    const SpecialisationMap& values) const {
    VkPipelineShaderStageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage = stage;
    info.module = module_;
    info.pName = "main";
    info.pSpecializationInfo = &values.info();
    return info;
}

} // namespace fieldcast::gpu
