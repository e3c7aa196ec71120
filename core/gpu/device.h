// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device_info.h"
#include "core/gpu/vulkan_error.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include <vulkan/vulkan.h>

namespace fieldcast::gpu {

struct DeviceState;

/// A Vulkan 1.3 device with one queue for compute and graphics. Required features: scalarBlockLayout,
/// bufferDeviceAddress, shaderInt64, synchronization2, hostQueryReset, maintenance4. Discrete devices are preferred to
/// integrated, virtual and CPU devices, in this order. Thread-safe: submissions take turns by a lock.
class Device {
public:
    /// Throws NoDeviceError without a usable device, UserError without the requested validation layer, and
    /// VulkanError.
    explicit Device(const DeviceOptions& options = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const;
    VkDevice handle() const;
    VkPhysicalDevice physical() const;
    std::uint32_t queue_family() const;

    /// Index of the first memory type that is in `type_bits` and has all properties of `wanted`; empty if none has.
    std::optional<std::uint32_t> memory_type(std::uint32_t type_bits, VkMemoryPropertyFlags wanted) const;

    /// Submits one command buffer and waits until the device has finished it. Throws VulkanError.
    void submit_and_wait(VkCommandBuffer commands) const;

    /// Number of errors and warnings that the validation layer has reported so far; 0 without validation.
    std::uint32_t validation_message_count() const;
    /// Texts of the first 64 of them, oldest first.
    std::vector<std::string> validation_messages() const;

    const DeviceState& state() const { return *state_; } ///< for core/gpu only

private:
    std::unique_ptr<DeviceState> state_;
};

} // namespace fieldcast::gpu
