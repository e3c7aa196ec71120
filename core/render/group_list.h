// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/command_recorder.h"

namespace fieldcast::render {

/// Groups of pixels that a kernel runs on. Idle groups are skipped, because a CPU device executes every instruction
/// even if no pixel of a group has work. Pixels of groups that are not listed keep their values.
class GroupList {
public:
    explicit GroupList(const gpu::Device& device);

    /// Makes room for `group_count` groups. Returns true if the room has changed; the list is undefined then.
    bool resize(std::uint32_t group_count);

    /// Lists every group. Blocks.
    void list_all();

    /// clear() sets all flags to 0. Kernels then set the flags of groups with a surface, and record() lists these
    /// groups in any order. With `width_px` (pixels per row; 0: unused), groups are kLinearGroup pixels of images of
    /// that width, and groups that touch a flagged one are listed, too. The list is visible after a barrier.
    void clear(gpu::CommandRecorder& recorder) const;
    void record(gpu::CommandRecorder& recorder, std::uint32_t width_px) const;

    /// One u32 per group.
    const gpu::Buffer& flags() const { return flags_; }
    /// Count, dispatch size and group indices, in the layout that lib/linear_index.glsl reads.
    const gpu::Buffer& list() const { return list_; }

private:
    const gpu::Device& device_;
    gpu::Kernel list_groups_;
    gpu::Kernel finish_;
    std::uint32_t group_count_ = 0;
    gpu::Buffer flags_;
    gpu::Buffer list_;
};

/// Dispatches a kernel that uses listed_index() or listed_group() on the groups of the list.
template <class Push>
void dispatch_listed(gpu::CommandRecorder& recorder, const gpu::Kernel& kernel,
                     std::initializer_list<const gpu::BindingSet*> sets, const Push& push, const GroupList& groups) {
    recorder.dispatch_indirect(kernel, sets, push, groups.list(), sizeof(std::uint32_t)); // skips the count
}

} // namespace fieldcast::render
