// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/buffer.h"

#include "core/base/error.h"
#include "core/gpu/device_state.h"
#include "core/gpu/format.h"
#include "core/gpu/run_once.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace fieldcast::gpu {
namespace {

constexpr std::uint64_t kMinBytes = 16;
constexpr std::uint64_t kStagingBytes = 16ULL << 20U; // largest staging buffer; the device keeps them

constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
constexpr VkMemoryPropertyFlags kShared = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags kCached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

/// Memory properties to try, best first. Vulkan guarantees that a memory type has the last entry of each list.
std::vector<VkMemoryPropertyFlags> wanted_properties(const Device& device, Memory memory) {
    switch (memory) {
    case Memory::kUpload:
        return {kShared};
    case Memory::kReadback:
        return {kShared | kCached, kShared};
    case Memory::kDevice:
        break;
    }
    if (device.info().is_cpu) {
        return {kLocal | kShared | kCached, kLocal | kShared, kLocal};
    }
    return {kLocal};
}

std::uint32_t choose_memory_type(const Device& device, std::uint32_t type_bits, Memory memory) {
    for (const auto wanted : wanted_properties(device, memory)) {
        if (const auto type = device.memory_type(type_bits, wanted)) {
            return *type;
        }
    }
    throw VulkanError("vkAllocateMemory: the device has no memory type for this buffer");
}

VkBufferUsageFlags usage_flags(const Device& device) {
    VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
                               VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                               VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT;
    if (device.info().has_ray_query) {
        usage |= VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR |
                 VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR;
    }
    return usage;
}

/// A staging buffer that waits for reuse.
struct KeptBuffer : Kept {
    explicit KeptBuffer(Buffer kept) : buffer(std::move(kept)) {}
    Buffer buffer;
};

IdleObjects<std::unique_ptr<Kept>>& idle_buffers(const Device& device, Memory memory) {
    const DeviceState& state = device.state();
    return memory == Memory::kUpload ? state.idle_upload_buffers : state.idle_readback_buffers;
}

/// An idle staging buffer of the device; empty if there is none.
Buffer take_idle(const Device& device, Memory memory) {
    auto idle = idle_buffers(device, memory).lock();
    if (idle->empty()) {
        return {};
    }
    Buffer taken = std::move(static_cast<KeptBuffer&>(*idle->back()).buffer);
    idle->pop_back();
    return taken;
}

/// Calls `copy(staging, offset, size)` for pieces of at most kStagingBytes. `copy` must have finished with the staging
/// buffer when it returns. After an exception the staging buffer is freed, not kept.
template <class Copy> void in_pieces(const Device& device, Memory memory, std::uint64_t size_bytes, Copy copy) {
    Buffer staging = take_idle(device, memory);
    make_room(device, staging, std::min(size_bytes, kStagingBytes), memory);
    for (std::uint64_t done = 0; done < size_bytes; done += kStagingBytes) {
        copy(staging, done, std::min(size_bytes - done, kStagingBytes));
    }
    auto kept = std::make_unique<KeptBuffer>(std::move(staging));
    idle_buffers(device, memory).lock()->push_back(std::move(kept));
}

/// Whether buffers of `memory` are mapped where the memory type allows it.
bool may_be_mapped(const Device& device, Memory memory) {
    return memory != Memory::kDevice || device.state().map_device_memory;
}

void copy_now(const Device& device, VkBuffer from, VkBuffer to, const VkBufferCopy& region) {
    run_once(device, [&](VkCommandBuffer commands) { vkCmdCopyBuffer(commands, from, to, 1, &region); });
}

} // namespace

Buffer::Buffer(const Device& device, std::uint64_t size_bytes, Memory memory) : Buffer() {
    device_ = device.handle();
    size_bytes_ = std::max(size_bytes, kMinBytes);

    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = size_bytes_;
    info.usage = usage_flags(device);
    info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
    check(vkCreateBuffer(device_, &info, nullptr, &buffer_), "vkCreateBuffer");

    VkMemoryRequirements requirements{};
    vkGetBufferMemoryRequirements(device_, buffer_, &requirements);
    VkMemoryAllocateFlagsInfo flags{};
    flags.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocate.pNext = &flags;
    allocate.allocationSize = requirements.size;
    allocate.memoryTypeIndex = choose_memory_type(device, requirements.memoryTypeBits, memory);
    check(vkAllocateMemory(device_, &allocate, nullptr, &memory_), "vkAllocateMemory");
    check(vkBindBufferMemory(device_, buffer_, memory_, 0), "vkBindBufferMemory");

    const auto properties = device.state().memory.memoryTypes[allocate.memoryTypeIndex].propertyFlags;
    if (may_be_mapped(device, memory) && (properties & kShared) == kShared) {
        void* pointer = nullptr;
        check(vkMapMemory(device_, memory_, 0, VK_WHOLE_SIZE, 0, &pointer), "vkMapMemory");
        mapped_ = static_cast<std::byte*>(pointer);
        is_cached_ = (properties & kCached) != 0;
    }
    VkBufferDeviceAddressInfo address{};
    address.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
    address.buffer = buffer_;
    address_ = vkGetBufferDeviceAddress(device_, &address);
}

Buffer::~Buffer() {
    release();
}

Buffer::Buffer(Buffer&& other) noexcept : Buffer() {
    *this = std::move(other);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    if (this != &other) {
        release();
        device_ = std::exchange(other.device_, VK_NULL_HANDLE);
        buffer_ = std::exchange(other.buffer_, VK_NULL_HANDLE);
        memory_ = std::exchange(other.memory_, VK_NULL_HANDLE);
        size_bytes_ = std::exchange(other.size_bytes_, 0);
        address_ = std::exchange(other.address_, 0);
        mapped_ = std::exchange(other.mapped_, nullptr);
        is_cached_ = std::exchange(other.is_cached_, false);
    }
    return *this;
}

void Buffer::release() noexcept {
    if (device_ != VK_NULL_HANDLE) {
        vkDestroyBuffer(device_, buffer_, nullptr);
        vkFreeMemory(device_, memory_, nullptr);
    }
}

void make_room(const Device& device, Buffer& buffer, std::uint64_t size_bytes, Memory memory) {
    if (buffer.size_bytes() < size_bytes) {
        buffer = {}; // frees the old memory before the new is allocated
        buffer = Buffer(device, size_bytes, memory);
    }
}

Buffer make_zero_buffer(const Device& device, std::uint64_t size_bytes) {
    Buffer buffer(device, size_bytes);
    run_once(device,
             [&](VkCommandBuffer commands) { vkCmdFillBuffer(commands, buffer.handle(), 0, VK_WHOLE_SIZE, 0); });
    return buffer;
}

void write_buffer(const Device& device, const Buffer& buffer, std::span<const std::byte> bytes,
                  std::uint64_t offset_bytes) {
    FC_ASSERT(offset_bytes <= buffer.size_bytes() && bytes.size() <= buffer.size_bytes() - offset_bytes,
              "write past the end of a buffer");
    if (bytes.empty()) {
        return;
    }
    if (buffer.mapped() != nullptr) {
        std::memcpy(buffer.mapped() + offset_bytes, bytes.data(), bytes.size());
        return;
    }
    const auto write = [&](const Buffer& staging, std::uint64_t offset, std::uint64_t size) {
        std::memcpy(staging.mapped(), bytes.data() + offset, size);
        copy_now(device, staging.handle(), buffer.handle(), {0, offset_bytes + offset, size});
    };
    in_pieces(device, Memory::kUpload, bytes.size(), write);
}

void read_buffer(const Device& device, const Buffer& buffer, std::span<std::byte> bytes, std::uint64_t offset_bytes) {
    FC_ASSERT(offset_bytes <= buffer.size_bytes() && bytes.size() <= buffer.size_bytes() - offset_bytes,
              "read past the end of a buffer");
    if (bytes.empty()) {
        return;
    }
    // The host reads uncached memory at a few hundred MB/s; a copy on the device is faster.
    if (buffer.mapped() != nullptr && buffer.is_cached()) {
        std::memcpy(bytes.data(), buffer.mapped() + offset_bytes, bytes.size());
        return;
    }
    const auto read = [&](const Buffer& staging, std::uint64_t offset, std::uint64_t size) {
        copy_now(device, buffer.handle(), staging.handle(), {offset_bytes + offset, 0, size});
        std::memcpy(bytes.data() + offset, staging.mapped(), size);
    };
    in_pieces(device, Memory::kReadback, bytes.size(), read);
}

TexelView::TexelView(const Device& device, const Buffer& buffer, VkFormat format, std::uint64_t offset_bytes,
                     std::uint64_t size_bytes)
    : device_(device.handle()) {
    const auto end_bytes = size_bytes == VK_WHOLE_SIZE ? buffer.size_bytes() : offset_bytes + size_bytes;
    FC_ASSERT(offset_bytes <= end_bytes && end_bytes <= buffer.size_bytes(), "texel view past the end of a buffer");
    const auto elements = (end_bytes - offset_bytes) / texel_bytes(format);
    if (elements > device.info().max_texel_buffer_elements) {
        throw VulkanError("vkCreateBufferView: " + std::to_string(elements) + " elements, but " + device.info().name +
                          " allows " + std::to_string(device.info().max_texel_buffer_elements));
    }
    VkBufferViewCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO;
    info.buffer = buffer.handle();
    info.format = format;
    info.offset = offset_bytes;
    info.range = elements * texel_bytes(format);
    check(vkCreateBufferView(device_, &info, nullptr, &view_), "vkCreateBufferView");
}

TexelView::~TexelView() {
    if (view_ != VK_NULL_HANDLE) {
        vkDestroyBufferView(device_, view_, nullptr);
    }
}

TexelView::TexelView(TexelView&& other) noexcept {
    *this = std::move(other);
}

TexelView& TexelView::operator=(TexelView&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(view_, other.view_);
    return *this;
}

} // namespace fieldcast::gpu
