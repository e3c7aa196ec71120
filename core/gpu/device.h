// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>
#include <vulkan/vulkan.h>

namespace fieldcast::gpu {

/// A Vulkan call failed; the message names the call and the result.
class VulkanError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// There is no usable Vulkan device; the message says what was found and what is missing.
class NoDeviceError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Throws VulkanError unless `result` is a success code.
void check(VkResult result, const char* call);

struct DeviceOptions {
    std::string name_contains{}; ///< picks the first device whose name contains this (case-insensitive); empty: best
    bool validation = false;     ///< VK_LAYER_KHRONOS_validation; messages are counted and logged
    bool allow_ray_query = true; ///< false: the device is created without ray tracing extensions
};

struct DeviceInfo {
    std::string name;           ///< "llvmpipe (LLVM 15.0.6, 256 bits)"
    std::string driver;         ///< "llvmpipe Mesa 25.0.7"
    std::string uuid_hex;       ///< device UUID + driver version: key for cached decisions
    bool is_cpu = false;        ///< a software implementation
    bool has_ray_query = false; ///< enabled on this device
    bool has_rasteriser = false; ///< can draw what RasterPass draws
    float timestamp_period_ns = 1.0F;
    std::uint32_t timestamp_bits = 64;
    std::uint32_t max_texel_buffer_elements = 0;
    std::uint64_t memory_bytes = 0; ///< of the largest heap that is the device's own
    std::uint32_t max_image_side = 0;
    std::uint32_t max_image_layers = 0;
    std::uint32_t subgroup_size = 0;
    VkPhysicalDeviceLimits limits{};
};

/// A Vulkan 1.3 device with one compute queue. Required features: scalarBlockLayout, bufferDeviceAddress, shaderInt64,
/// synchronization2, hostQueryReset. Preference: discrete, integrated, virtual, CPU.
/// One recorder at a time may submit; `submit` locks.
class Device {
public:
    explicit Device(const DeviceOptions& options = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const;
    VkDevice handle() const;
    VkPhysicalDevice physical() const;
    std::uint32_t queue_family() const;

    /// Index of a memory type allowed by `type_bits` with all of `wanted`, if there is one.
    std::optional<std::uint32_t> memory_type(std::uint32_t type_bits, VkMemoryPropertyFlags wanted) const;

    /// Submits one command buffer and waits until the device has finished it.
    void submit_and_wait(VkCommandBuffer commands) const;

    /// Errors and warnings the validation layer has reported so far (0 without validation).
    std::uint32_t validation_message_count() const;
    /// Their texts, oldest first, at most 64.
    std::vector<std::string> validation_messages() const;

    struct State; ///< handles and loaded extension functions, for core/gpu only
    const State& state() const { return *state_; }

private:
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::gpu
