// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/texture.h"

namespace fieldcast::gpu {

class AccelerationStructure;

enum class BindingType { kTexelBuffer, kTexture, kAccelerationStructure };

struct Binding {
    std::uint32_t binding = 0;
    BindingType type = BindingType::kTexelBuffer;
    std::uint32_t count = 1; ///< array size in the shader; every element must be set before use
};

/// Layout of one descriptor set.
class BindingLayout {
public:
    BindingLayout(const Device& device, std::vector<Binding> bindings);
    ~BindingLayout();
    BindingLayout(const BindingLayout&) = delete;
    BindingLayout& operator=(const BindingLayout&) = delete;

    VkDescriptorSetLayout handle() const { return layout_; }
    const std::vector<Binding>& bindings() const { return bindings_; }

private:
    VkDevice device_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout layout_ = VK_NULL_HANDLE;
    std::vector<Binding> bindings_;
};

/// One descriptor set with its own pool. Set members only while no submitted work uses it.
class BindingSet {
public:
    BindingSet() = default;
    BindingSet(const Device& device, const BindingLayout& layout);
    ~BindingSet();
    BindingSet(BindingSet&& other) noexcept;
    BindingSet& operator=(BindingSet&& other) noexcept;

    void set(std::uint32_t binding, const TexelView& view, std::uint32_t element = 0);
    void set(std::uint32_t binding, const Texture& texture, std::uint32_t element = 0);
    void set(std::uint32_t binding, const AccelerationStructure& structure);
    VkDescriptorSet handle() const { return set_; }

private:
    VkDevice device_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};

} // namespace fieldcast::gpu
