// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/texture.h"

#include <cstdint>
#include <vector>

namespace fieldcast::gpu {

class AccelerationStructure;

/// Kinds of resources that a shader reads through a descriptor set.
enum class BindingType { kTexelBuffer, kTexture, kAccelerationStructure };

/// One binding of a descriptor set.
struct Binding {
    std::uint32_t binding = 0;
    BindingType type = BindingType::kTexelBuffer;
    std::uint32_t count = 1; ///< array size in the shader; every element must be set before use
};

/// Layout of one descriptor set, for compute and fragment shaders. Throws VulkanError.
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

/// One descriptor set with its own pool. set() may be called only while no submitted work uses the set.
class BindingSet {
public:
    BindingSet() = default;
    /// Throws VulkanError.
    BindingSet(const Device& device, const BindingLayout& layout);
    ~BindingSet();
    BindingSet(BindingSet&& other) noexcept;
    BindingSet& operator=(BindingSet&& other) noexcept;

    /// Puts a resource at `binding`; `element` is the index in an array of the shader. The resource must outlive the
    /// use.
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
