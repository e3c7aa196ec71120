// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/bindings.h"

#include "core/gpu/acceleration_structure.h"

#include <utility>

namespace fieldcast::gpu {
namespace {

VkDescriptorType descriptor_type(BindingType type) {
    switch (type) {
    case BindingType::kTexelBuffer:
        return VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    case BindingType::kTexture:
        return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    case BindingType::kAccelerationStructure:
        return VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR;
    }
    return VK_DESCRIPTOR_TYPE_MAX_ENUM;
}

VkWriteDescriptorSet write_of(VkDescriptorSet set, std::uint32_t binding, std::uint32_t element, BindingType type) {
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set;
    write.dstBinding = binding;
    write.dstArrayElement = element;
    write.descriptorCount = 1;
    write.descriptorType = descriptor_type(type);
    return write;
}

} // namespace

BindingLayout::BindingLayout(const Device& device, std::vector<Binding> bindings)
    : device_(device.handle()), bindings_(std::move(bindings)) {
    std::vector<VkDescriptorSetLayoutBinding> entries;
    for (const auto& binding : bindings_) {
        VkDescriptorSetLayoutBinding entry{};
        entry.binding = binding.binding;
        entry.descriptorType = descriptor_type(binding.type);
        entry.descriptorCount = binding.count;
        entry.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
        entries.push_back(entry);
    }
    VkDescriptorSetLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    info.bindingCount = static_cast<std::uint32_t>(entries.size());
    info.pBindings = entries.data();
    check(vkCreateDescriptorSetLayout(device_, &info, nullptr, &layout_), "vkCreateDescriptorSetLayout");
}

BindingLayout::~BindingLayout() {
    vkDestroyDescriptorSetLayout(device_, layout_, nullptr);
}

BindingSet::BindingSet(const Device& device, const BindingLayout& layout) : BindingSet() {
    device_ = device.handle();
    std::vector<VkDescriptorPoolSize> sizes;
    for (const auto& binding : layout.bindings()) {
        sizes.push_back({descriptor_type(binding.type), binding.count});
    }
    VkDescriptorPoolCreateInfo pool_info{};
    pool_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool_info.maxSets = 1;
    pool_info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    pool_info.pPoolSizes = sizes.data();
    check(vkCreateDescriptorPool(device_, &pool_info, nullptr, &pool_), "vkCreateDescriptorPool");

    const VkDescriptorSetLayout layout_handle = layout.handle();
    VkDescriptorSetAllocateInfo set_info{};
    set_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    set_info.descriptorPool = pool_;
    set_info.descriptorSetCount = 1;
    set_info.pSetLayouts = &layout_handle;
    check(vkAllocateDescriptorSets(device_, &set_info, &set_), "vkAllocateDescriptorSets");
}

BindingSet::~BindingSet() {
    if (pool_ != VK_NULL_HANDLE) {
        vkDestroyDescriptorPool(device_, pool_, nullptr);
    }
}

BindingSet::BindingSet(BindingSet&& other) noexcept : BindingSet() {
    *this = std::move(other);
}

BindingSet& BindingSet::operator=(BindingSet&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(pool_, other.pool_);
    std::swap(set_, other.set_);
    return *this;
}

void BindingSet::set(std::uint32_t binding, const TexelView& view, std::uint32_t element) {
    const VkBufferView handle = view.handle();
    auto write = write_of(set_, binding, element, BindingType::kTexelBuffer);
    write.pTexelBufferView = &handle;
    vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
}

void BindingSet::set(std::uint32_t binding, const Texture& texture, std::uint32_t element) {
    const VkDescriptorImageInfo image = {texture.sampler(), texture.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    auto write = write_of(set_, binding, element, BindingType::kTexture);
    write.pImageInfo = &image;
    vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
}

void BindingSet::set(std::uint32_t binding, const AccelerationStructure& structure) {
    const VkAccelerationStructureKHR handle = structure.handle();
    VkWriteDescriptorSetAccelerationStructureKHR info{};
    info.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR;
    info.accelerationStructureCount = 1;
    info.pAccelerationStructures = &handle;
    auto write = write_of(set_, binding, 0, BindingType::kAccelerationStructure);
    write.pNext = &info;
    vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
}

} // namespace fieldcast::gpu
