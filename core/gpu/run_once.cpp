// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/run_once.h"

#include "core/gpu/device_state.h"

namespace fieldcast::gpu {
namespace {

/// Idle commands of the device; null handles if there are none.
OneTimeCommands take_idle(const DeviceState& state) {
    auto idle = state.idle_commands.lock();
    if (idle->empty()) {
        return {};
    }
    const OneTimeCommands taken = idle->back();
    idle->pop_back();
    return taken;
}

void create(const Device& device, OneTimeCommands& once) {
    VkCommandPoolCreateInfo pool_info{};
    pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool_info.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool_info.queueFamilyIndex = device.queue_family();
    check(vkCreateCommandPool(device.handle(), &pool_info, nullptr, &once.pool), "vkCreateCommandPool");
    VkCommandBufferAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    info.commandPool = once.pool;
    info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    info.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(device.handle(), &info, &once.commands), "vkAllocateCommandBuffers");
}

void begin(const Device& device, const OneTimeCommands& once) {
    check(vkResetCommandPool(device.handle(), once.pool, 0), "vkResetCommandPool");
    VkCommandBufferBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(once.commands, &info), "vkBeginCommandBuffer");
}

/// All writes become visible to later submissions and to the host, which the fence alone does not ensure.
void publish_writes(VkCommandBuffer commands) {
    VkMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

} // namespace

void run_once(const Device& device, const std::function<void(VkCommandBuffer)>& record) {
    OneTimeCommands once = take_idle(device.state());
    try {
        if (once.pool == VK_NULL_HANDLE) {
            create(device, once);
        }
        begin(device, once);
        record(once.commands);
        publish_writes(once.commands);
        check(vkEndCommandBuffer(once.commands), "vkEndCommandBuffer");
        device.submit_and_wait(once.commands);
        device.state().idle_commands.lock()->push_back(once);
    } catch (...) {
        vkDestroyCommandPool(device.handle(), once.pool, nullptr);
        throw;
    }
}

} // namespace fieldcast::gpu
