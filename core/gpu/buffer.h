// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>

namespace fieldcast::gpu {

enum class Memory {
    kDevice,   ///< fastest for kernels; may be mappable (it is on CPU devices)
    kUpload,   ///< written by the host, read by copies or kernels
    kReadback, ///< host-cached, written by copies
};

/// One VkBuffer with its own memory and device address; usable for storage, texel, indirect, transfer and
/// acceleration structure input. Size is rounded up to at least 16 bytes. Contents are undefined until written.
class Buffer {
public:
    Buffer() = default;
    Buffer(const Device& device, std::uint64_t size_bytes, Memory memory = Memory::kDevice);
    ~Buffer();
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;

    VkBuffer handle() const { return buffer_; }
    std::uint64_t size_bytes() const { return size_bytes_; }
    std::uint64_t address() const { return address_; } ///< for push constants
    std::byte* mapped() const { return mapped_; }      ///< null for kDevice memory that is not host visible
    bool is_cached() const { return is_cached_; }      ///< `mapped()` may be read at full speed
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

/// Writes host data into a buffer (any memory), through a staging copy where needed. Blocks.
void write_buffer(const Device& device, const Buffer& buffer, std::span<const std::byte> bytes,
                  std::uint64_t offset_bytes = 0);

/// Reads back `bytes.size()` bytes from any buffer. Blocks.
void read_buffer(const Device& device, const Buffer& buffer, std::span<std::byte> bytes,
                 std::uint64_t offset_bytes = 0);

/// A device buffer of zeros. Blocks.
Buffer make_zero_buffer(const Device& device, std::uint64_t size_bytes);

/// A device buffer holding a copy of `values` (at least 16 bytes even if empty).
template <class T>
requires std::is_trivially_copyable_v<T> Buffer make_buffer(const Device& device, std::span<const T> values) {
    Buffer buffer(device, values.size_bytes());
    if (!values.empty()) {
        write_buffer(device, buffer, std::as_bytes(values));
    }
    return buffer;
}

template <class T>
requires std::is_trivially_copyable_v<T> std::vector<T>
read_buffer_as(const Device& device, const Buffer& buffer, std::size_t count, std::uint64_t offset_bytes = 0) {
    std::vector<T> values(count);
    read_buffer(device, buffer, std::as_writable_bytes(std::span(values)), offset_bytes);
    return values;
}

/// Typed view of a buffer for `samplerBuffer`/`usamplerBuffer` fetches.
class TexelView {
public:
    TexelView() = default;
    /// Throws UserError-like VulkanError if the element count exceeds the device's limit.
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
