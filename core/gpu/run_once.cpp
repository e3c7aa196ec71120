// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/run_once.h"

namespace fieldcast::gpu {
namespace {

/// A command pool with one command buffer, for `run_once`.
class OneTimeCommands {
public:
    explicit OneTimeCommands(const Device& device) : device_(device.handle()) {
        VkCommandPoolCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        info.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
        info.queueFamilyIndex = device.queue_family();
        check(vkCreateCommandPool(device_, &info, nullptr, &pool_), "vkCreateCommandPool");
    }
    ~OneTimeCommands() { vkDestroyCommandPool(device_, pool_, nullptr); }
    OneTimeCommands(const OneTimeCommands&) = delete;
    OneTimeCommands& operator=(const OneTimeCommands&) = delete;

    VkCommandBuffer begin() const {
        VkCommandBufferAllocateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        info.commandPool = pool_;
        info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        info.commandBufferCount = 1;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        check(vkAllocateCommandBuffers(device_, &info, &commands), "vkAllocateCommandBuffers");
        VkCommandBufferBeginInfo begin_info{};
        begin_info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        begin_info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
        check(vkBeginCommandBuffer(commands, &begin_info), "vkBeginCommandBuffer");
        return commands;
    }

private:
    VkDevice device_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
};

} // namespace

void run_once(const Device& device, const std::function<void(VkCommandBuffer)>& record) {
    const OneTimeCommands once(device);
    const VkCommandBuffer commands = once.begin();
    record(commands);
    check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
    device.submit_and_wait(commands);
}

} // namespace fieldcast::gpu
