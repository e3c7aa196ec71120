// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/kernel.h"

#include <array>

namespace fieldcast::gpu {

struct GroupCount {
    std::uint32_t x = 1;
    std::uint32_t y = 1;
    std::uint32_t z = 1;
};

/// Groups of `group_size` items that cover `items`.
constexpr std::uint32_t groups_for(std::uint32_t items, std::uint32_t group_size) {
    return (items + group_size - 1) / group_size;
}

/// Duration of a stage between two timestamps.
struct StageDuration {
    std::string stage;
    double ms = 0.0;
};

/// Records one command buffer at a time, submits it and waits. Reusable: submit() starts a new recording.
///
///   recorder.stage("trace");           // every following command until the next stage() counts for "trace"
///   trace_.record(recorder, params);
///   recorder.barrier();
///   recorder.submit();
///   recorder.durations();              // of the submission just finished; equal names are summed
class Recorder {
public:
    explicit Recorder(const Device& device);
    ~Recorder();
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    /// Starts a named stage (at most 64 per submission).
    void stage(const std::string& name);

    /// `push` must have exactly the kernel's push_bytes. Sets may be empty handles where the kernel has none.
    void dispatch_raw(const Kernel& kernel, std::span<const VkDescriptorSet> sets, std::span<const std::byte> push,
                      GroupCount groups);
    void dispatch_indirect_raw(const Kernel& kernel, std::span<const VkDescriptorSet> sets,
                               std::span<const std::byte> push, const Buffer& group_counts, std::uint64_t offset_bytes);

    template <class Push>
    void dispatch(const Kernel& kernel, std::initializer_list<const BindingSet*> sets, const Push& push,
                  GroupCount groups) {
        const auto handles = set_handles(sets);
        dispatch_raw(kernel, std::span(handles.data(), sets.size()), std::as_bytes(std::span(&push, 1)), groups);
    }
    /// `group_counts` holds three u32 at `offset_bytes`.
    template <class Push>
    void dispatch_indirect(const Kernel& kernel, std::initializer_list<const BindingSet*> sets, const Push& push,
                           const Buffer& group_counts, std::uint64_t offset_bytes = 0) {
        const auto handles = set_handles(sets);
        dispatch_indirect_raw(kernel, std::span(handles.data(), sets.size()), std::as_bytes(std::span(&push, 1)),
                              group_counts, offset_bytes);
    }

    void fill(const Buffer& buffer, std::uint32_t value, std::uint64_t offset_bytes = 0,
              std::uint64_t size_bytes = VK_WHOLE_SIZE);
    void copy(const Buffer& from, const Buffer& to, std::uint64_t size_bytes, std::uint64_t from_offset = 0,
              std::uint64_t to_offset = 0);

    /// All earlier compute, transfer and build writes become visible to all later compute, indirect, transfer and
    /// host reads.
    void barrier();

    /// Submits and waits; `durations()` are then valid and a new recording has begun.
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
