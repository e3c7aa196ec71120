// SPDX-License-Identifier: Apache-2.0
#include "core/render/group_list.h"

#include "core/render/frame_parameters.h"
#include "core/render/kernels.h"
#include "shaders/shared/frame.h"

#include <numeric>

namespace fieldcast::render {

static_assert(shared::kGroupListDispatch == 1);

GroupList::GroupList(const gpu::Device& device)
    : device_(device), kernel_(make_plain_kernel(device, KernelId::kListGroups, sizeof(shared::ListGroupsParams))) {}

bool GroupList::resize(std::uint32_t group_count) {
    if (group_count == group_count_) {
        return false;
    }
    group_count_ = group_count;
    flags_ = gpu::Buffer(device_, 4ULL * group_count);
    list_ = gpu::Buffer(device_, 4ULL * (shared::kGroupListFirst + group_count));
    return true;
}

void GroupList::list_all() {
    const gpu::GroupCount groups = linear_groups(group_count_ * shared::kLinearGroup);
    std::vector<std::uint32_t> list{group_count_, groups.x, groups.y, groups.z};
    list.resize(shared::kGroupListFirst + group_count_);
    std::iota(list.begin() + shared::kGroupListFirst, list.end(), 0U);
    gpu::write_buffer(device_, list_, std::as_bytes(std::span(list)));
}

void GroupList::clear(gpu::Recorder& recorder) const {
    recorder.fill(flags_, 0);
}

void GroupList::record(gpu::Recorder& recorder, std::uint32_t width_px) const {
    recorder.dispatch(kernel_, {}, shared::ListGroupsParams{flags_.address(), list_.address(), width_px, group_count_},
                      {});
}

} // namespace fieldcast::render
