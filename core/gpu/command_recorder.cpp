// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/command_recorder.h"

#include "core/base/error.h"

#include <algorithm>

namespace fieldcast::gpu {
namespace {

constexpr std::uint32_t kMaxStages = 64;
constexpr std::size_t kMaxUpdateBytes = 65536; // of one vkCmdUpdateBuffer

void bind(VkCommandBuffer commands, const Kernel& kernel, std::span<const VkDescriptorSet> sets,
          std::span<const std::byte> push) {
    FC_ASSERT(push.size() == kernel.push_bytes(), "push constants differ in size from what the kernel declares");
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.pipeline());
    for (std::uint32_t index = 0; index < sets.size(); ++index) {
        if (sets[index] != VK_NULL_HANDLE) {
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.layout(), index, 1, &sets[index],
                                    0, nullptr);
        }
    }
    if (!push.empty()) {
        vkCmdPushConstants(commands, kernel.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                           static_cast<std::uint32_t>(push.size()), push.data());
    }
}

bool is_within(const GroupCount& groups, const VkPhysicalDeviceLimits& limits) {
    const auto& most = limits.maxComputeWorkGroupCount;
    return groups.x <= most[0] && groups.y <= most[1] && groups.z <= most[2];
}

} // namespace

CommandRecorder::CommandRecorder(const Device& device) : device_(device) {
    try {
        create();
        begin();
    } catch (...) {
        release();
        throw;
    }
}

CommandRecorder::~CommandRecorder() {
    release();
}

void CommandRecorder::create() {
    VkCommandPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool.queueFamilyIndex = device_.queue_family();
    check(vkCreateCommandPool(device_.handle(), &pool, nullptr, &pool_), "vkCreateCommandPool");

    VkCommandBufferAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocate.commandPool = pool_;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(device_.handle(), &allocate, &commands_), "vkAllocateCommandBuffers");

    VkQueryPoolCreateInfo queries{};
    queries.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    queries.queryType = VK_QUERY_TYPE_TIMESTAMP;
    queries.queryCount = kMaxStages + 1;
    check(vkCreateQueryPool(device_.handle(), &queries, nullptr, &queries_), "vkCreateQueryPool");
}

void CommandRecorder::release() noexcept {
    vkDestroyQueryPool(device_.handle(), queries_, nullptr);
    vkDestroyCommandPool(device_.handle(), pool_, nullptr);
}

void CommandRecorder::begin() {
    check(vkResetCommandPool(device_.handle(), pool_, 0), "vkResetCommandPool");
    vkResetQueryPool(device_.handle(), queries_, 0, kMaxStages + 1);
    stages_.clear();
    VkCommandBufferBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands_, &info), "vkBeginCommandBuffer");
}

void CommandRecorder::write_timestamp() {
    if (device_.info().timestamp_bits > 0) {
        vkCmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_,
                             static_cast<std::uint32_t>(stages_.size()));
    }
}

void CommandRecorder::stage(const std::string& name) {
    FC_ASSERT(stages_.size() < kMaxStages, "too many stages in one submission");
    write_timestamp();
    stages_.push_back(name);
    if (device_.info().is_cpu) {
        barrier(); // once it has drawn, Mesa's software driver takes timestamps only when it next waits
    }
}

void CommandRecorder::dispatch_raw(const Kernel& kernel, std::span<const VkDescriptorSet> sets,
                                   std::span<const std::byte> push, GroupCount groups) {
    FC_ASSERT(is_within(groups, device_.info().limits), "more workgroups than the device allows");
    bind(commands_, kernel, sets, push);
    vkCmdDispatch(commands_, groups.x, groups.y, groups.z);
}

void CommandRecorder::dispatch_indirect_raw(const Kernel& kernel, std::span<const VkDescriptorSet> sets,
                                            std::span<const std::byte> push, const Buffer& group_counts,
                                            std::uint64_t offset_bytes) {
    bind(commands_, kernel, sets, push);
    vkCmdDispatchIndirect(commands_, group_counts.handle(), offset_bytes);
}

void CommandRecorder::fill(const Buffer& buffer, std::uint32_t value, std::uint64_t offset_bytes,
                           std::uint64_t size_bytes) {
    if (size_bytes != 0) {
        vkCmdFillBuffer(commands_, buffer.handle(), offset_bytes, size_bytes, value);
    }
}

void CommandRecorder::copy(const Buffer& from, const Buffer& to, std::uint64_t size_bytes, std::uint64_t from_offset,
                           std::uint64_t to_offset) {
    if (size_bytes != 0) {
        const VkBufferCopy region = {from_offset, to_offset, size_bytes};
        vkCmdCopyBuffer(commands_, from.handle(), to.handle(), 1, &region);
    }
}

void CommandRecorder::update(const Buffer& buffer, std::span<const std::byte> bytes, std::uint64_t offset_bytes) {
    FC_ASSERT(offset_bytes % 4 == 0 && bytes.size() % 4 == 0, "updates consist of words of 4 bytes");
    FC_ASSERT(offset_bytes <= buffer.size_bytes() && bytes.size() <= buffer.size_bytes() - offset_bytes,
              "update past the end of a buffer");
    for (std::size_t done = 0; done < bytes.size(); done += kMaxUpdateBytes) {
        const std::span<const std::byte> piece = bytes.subspan(done, std::min(kMaxUpdateBytes, bytes.size() - done));
        vkCmdUpdateBuffer(commands_, buffer.handle(), offset_bytes + done, piece.size(), piece.data());
    }
}

void CommandRecorder::barrier() {
    VkMemoryBarrier2 memory{};
    memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
    memory.srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    memory.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    memory.dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT |
                          VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT |
                          VK_PIPELINE_STAGE_2_HOST_BIT;
    memory.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    if (device_.info().has_ray_query) {
        memory.srcStageMask |= VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;
        memory.dstStageMask |= VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;
    }
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &memory;
    vkCmdPipelineBarrier2(commands_, &dependency);
}

void CommandRecorder::submit() {
    barrier(); // what the last command wrote becomes visible to the host
    write_timestamp();
    check(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
    device_.submit_and_wait(commands_);
    collect_durations();
    begin();
}

void CommandRecorder::collect_durations() {
    durations_.clear();
    if (stages_.empty()) {
        return;
    }
    std::vector<std::uint64_t> ticks(stages_.size() + 1);
    if (device_.info().timestamp_bits > 0) {
        check(vkGetQueryPoolResults(device_.handle(), queries_, 0, static_cast<std::uint32_t>(ticks.size()),
                                    ticks.size() * sizeof(ticks[0]), ticks.data(), sizeof(ticks[0]),
                                    VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
              "vkGetQueryPoolResults");
    }
    const auto bits = std::clamp(device_.info().timestamp_bits, 1U, 64U);
    const std::uint64_t valid = ~std::uint64_t{0} >> (64U - bits);
    for (std::size_t index = 0; index < stages_.size(); ++index) {
        const auto elapsed = static_cast<double>((ticks[index + 1] - ticks[index]) & valid);
        const double ms = elapsed * static_cast<double>(device_.info().timestamp_period_ns) * 1e-6;
        const auto same = std::ranges::find(durations_, stages_[index], &StageDuration::stage);
        if (same == durations_.end()) {
            durations_.push_back({stages_[index], ms});
        } else {
            same->ms += ms;
        }
    }
}

std::array<VkDescriptorSet, 4> CommandRecorder::set_handles(std::initializer_list<const BindingSet*> sets) {
    std::array<VkDescriptorSet, 4> handles{};
    FC_ASSERT(sets.size() <= handles.size(), "a kernel has at most four sets");
    std::ranges::transform(sets, handles.begin(),
                           [](const BindingSet* set) { return set != nullptr ? set->handle() : VK_NULL_HANDLE; });
    return handles;
}

} // namespace fieldcast::gpu
