// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/kernel.h"

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace fieldcast::gpu {

/// Number of workgroups of a dispatch in each direction.
struct GroupCount {
    std::uint32_t x = 1;
    std::uint32_t y = 1;
    std::uint32_t z = 1;
};

/// Number of groups of `group_size` items that cover `items`.
constexpr std::uint32_t groups_for(std::uint32_t items, std::uint32_t group_size) {
    return (items + group_size - 1) / group_size;
}

/// Time that the device took for a stage.
struct StageDuration {
    std::string stage;
    double ms = 0.0;
};

/// Records one command buffer at a time, submits it and waits. Reusable: submit() starts a new recording. Not
/// thread-safe.
///
///   recorder.stage("trace");           // the time of all commands until the next stage() counts for "trace"
///   trace_.record(recorder, params);
///   recorder.barrier();
///   recorder.submit();
///   recorder.durations();              // of the last submission; times of equal names are added
class CommandRecorder {
public:
    /// Throws VulkanError.
    explicit CommandRecorder(const Device& device);
    ~CommandRecorder();
    CommandRecorder(const CommandRecorder&) = delete;
    CommandRecorder& operator=(const CommandRecorder&) = delete;

    /// Starts a named stage (at most 64 per submission).
    void stage(const std::string& name);

    /// `push` must have exactly the kernel's push_bytes. A handle is null where the kernel has no set.
    void dispatch_raw(const Kernel& kernel, std::span<const VkDescriptorSet> sets, std::span<const std::byte> push,
                      GroupCount groups);
    void dispatch_indirect_raw(const Kernel& kernel, std::span<const VkDescriptorSet> sets,
                               std::span<const std::byte> push, const Buffer& group_counts, std::uint64_t offset_bytes);

    /// Runs a kernel in `groups` workgroups. A set is null where the kernel has none.
    template <class Push>
    void dispatch(const Kernel& kernel, std::initializer_list<const BindingSet*> sets, const Push& push,
                  GroupCount groups) {
        const auto handles = set_handles(sets);
        dispatch_raw(kernel, std::span(handles.data(), sets.size()), std::as_bytes(std::span(&push, 1)), groups);
    }
    /// Runs a kernel in as many workgroups as `group_counts` holds: three u32 at `offset_bytes`.
    template <class Push>
    void dispatch_indirect(const Kernel& kernel, std::initializer_list<const BindingSet*> sets, const Push& push,
                           const Buffer& group_counts, std::uint64_t offset_bytes = 0) {
        const auto handles = set_handles(sets);
        dispatch_indirect_raw(kernel, std::span(handles.data(), sets.size()), std::as_bytes(std::span(&push, 1)),
                              group_counts, offset_bytes);
    }

    /// Fills a part of a buffer with a repeated 32-bit word. Offset and size are multiples of 4 bytes.
    void fill(const Buffer& buffer, std::uint32_t value, std::uint64_t offset_bytes = 0,
              std::uint64_t size_bytes = VK_WHOLE_SIZE);
    /// Copies `size_bytes` from one buffer to another.
    void copy(const Buffer& from, const Buffer& to, std::uint64_t size_bytes, std::uint64_t from_offset = 0,
              std::uint64_t to_offset = 0);

    /// Writes host data into a buffer when the commands run; `bytes` is copied now. For small data: it travels in the
    /// command buffer. Offset and size are multiples of 4 bytes.
    void update(const Buffer& buffer, std::span<const std::byte> bytes, std::uint64_t offset_bytes = 0);

    /// Makes all earlier compute, transfer and build writes visible to all later accesses by compute and fragment
    /// shaders, indirect dispatches, transfers and the host.
    void barrier();

    /// Submits the recorded commands and waits. Then durations() are valid and a new recording has begun. Throws
    /// VulkanError.
    void submit();

    const std::vector<StageDuration>& durations() const { return durations_; }
    VkCommandBuffer commands() const { return commands_; } ///< for core/gpu

private:
    static std::array<VkDescriptorSet, 4> set_handles(std::initializer_list<const BindingSet*> sets);
    void create();
    void release() noexcept;
    void begin();
    void write_timestamp();
    void collect_durations();

    const Device& device_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkQueryPool queries_ = VK_NULL_HANDLE;
    std::vector<std::string> stages_;
    std::vector<StageDuration> durations_;
};

} // namespace fieldcast::gpu
