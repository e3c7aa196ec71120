// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace fieldcast::gpu {

/// Kinds of memory of a buffer.
enum class Memory {
    kDevice,   ///< fastest for kernels; may be mapped, as on CPU devices
    kUpload,   ///< written by the host, read by copies or kernels
    kReadback, ///< host-cached, written by copies
};

/// One VkBuffer with its own memory and device address, for storage, texel views, indirect dispatches, transfers,
/// vertices, indices and acceleration structures. Its size is at least 16 bytes. Its contents are undefined until they
/// are written.
class Buffer {
public:
    Buffer() = default;
    /// Throws VulkanError if there is no memory.
    Buffer(const Device& device, std::uint64_t size_bytes, Memory memory = Memory::kDevice);
    ~Buffer();
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;

    VkBuffer handle() const { return buffer_; }
    std::uint64_t size_bytes() const { return size_bytes_; }
    std::uint64_t address() const { return address_; } ///< for push constants
    std::byte* mapped() const { return mapped_; }      ///< null for kDevice memory that is not host-visible
    bool is_cached() const { return is_cached_; }      ///< mapped in host-cached memory, which reads at full speed
    explicit operator bool() const { return buffer_ != VK_NULL_HANDLE; }

private:
    void release() noexcept;

    VkDevice device_ = VK_NULL_HANDLE;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    std::uint64_t size_bytes_ = 0;
    std::uint64_t address_ = 0;
    std::byte* mapped_ = nullptr;
    bool is_cached_ = false;
};

/// Makes `buffer` hold at least `size_bytes`: a smaller one is replaced, and its contents are lost. No submitted work
/// may use it. Throws VulkanError; `buffer` is then empty.
void make_room(const Device& device, Buffer& buffer, std::uint64_t size_bytes, Memory memory = Memory::kDevice);

/// Writes host data into a buffer of any memory, through a staging buffer where needed. Blocks. Thread-safe. Throws
/// VulkanError.
void write_buffer(const Device& device, const Buffer& buffer, std::span<const std::byte> bytes,
                  std::uint64_t offset_bytes = 0);

/// Reads `bytes.size()` bytes from a buffer of any memory, through a staging buffer where needed. Blocks. Thread-safe.
/// Throws VulkanError.
void read_buffer(const Device& device, const Buffer& buffer, std::span<std::byte> bytes,
                 std::uint64_t offset_bytes = 0);

/// A device buffer of zeros. Blocks. Throws VulkanError.
Buffer make_zero_buffer(const Device& device, std::uint64_t size_bytes);

/// A device buffer that holds a copy of `values` (at least 16 bytes even if empty). Blocks. Throws VulkanError.
template <class T>
requires std::is_trivially_copyable_v<T> Buffer make_buffer(const Device& device, std::span<const T> values) {
    Buffer buffer(device, values.size_bytes());
    if (!values.empty()) {
        write_buffer(device, buffer, std::as_bytes(values));
    }
    return buffer;
}

/// Reads `count` values from `offset_bytes` on. Blocks. Throws VulkanError.
template <class T>
requires std::is_trivially_copyable_v<T> std::vector<T>
read_buffer_as(const Device& device, const Buffer& buffer, std::size_t count, std::uint64_t offset_bytes = 0) {
    std::vector<T> values(count);
    read_buffer(device, buffer, std::as_writable_bytes(std::span(values)), offset_bytes);
    return values;
}

/// Typed view of a buffer, for fetches of `samplerBuffer` and `usamplerBuffer`. The buffer must outlive it.
class TexelView {
public:
    TexelView() = default;
    /// Throws VulkanError, which names the limit, if the view has more elements than the device allows.
    TexelView(const Device& device, const Buffer& buffer, VkFormat format, std::uint64_t offset_bytes = 0,
              std::uint64_t size_bytes = VK_WHOLE_SIZE);
    ~TexelView();
    TexelView(TexelView&& other) noexcept;
    TexelView& operator=(TexelView&& other) noexcept;
    VkBufferView handle() const { return view_; }

private:
    VkDevice device_ = VK_NULL_HANDLE;
    VkBufferView view_ = VK_NULL_HANDLE;
};

} // namespace fieldcast::gpu
