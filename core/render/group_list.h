// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/recorder.h"

namespace fieldcast::render {

/// Groups of pixels to which a kernel's work is confined: a CPU device goes through every instruction even where
/// no pixel of a group has anything to do. Pixels of other groups keep what they hold.
class GroupList {
public:
    explicit GroupList(const gpu::Device& device);

    /// Room for so many groups. True: it has changed and the list is undefined.
    bool resize(std::uint32_t group_count);

    /// Every group. Blocks.
    void list_all();

    /// All flags 0; then kernels set those of groups with a surface, and `record` lists them, with `width_px` together
    /// with those that touch them, in any order: groups of kLinearGroup pixels of pictures of that width. Visible after
    /// a barrier.
    void clear(gpu::Recorder& recorder) const;
    void record(gpu::Recorder& recorder, std::uint32_t width_px) const;

    /// One u32 per group.
    const gpu::Buffer& flags() const { return flags_; }
    /// As lib/linear_index.glsl wants it.
    const gpu::Buffer& list() const { return list_; }

private:
    const gpu::Device& device_;
    gpu::Kernel list_groups_;
    gpu::Kernel finish_;
    std::uint32_t group_count_ = 0;
    gpu::Buffer flags_;
    gpu::Buffer list_;
};

/// Runs a kernel that asks for listed_index() or listed_group() on the groups of the list.
template <class Push>
void dispatch_listed(gpu::Recorder& recorder, const gpu::Kernel& kernel,
                     std::initializer_list<const gpu::BindingSet*> sets, const Push& push, const GroupList& groups) {
    recorder.dispatch_indirect(kernel, sets, push, groups.list(), sizeof(std::uint32_t)); // after the length
}

} // namespace fieldcast::render
