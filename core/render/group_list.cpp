// SPDX-License-Identifier: Apache-2.0
#include "core/render/group_list.h"

#include "core/render/frame_parameters.h"
#include "core/render/kernels.h"
#include "shaders/shared/frame.h"

#include <numeric>

namespace fieldcast::render {

static_assert(shared::kGroupListDispatch == shared::kGroupListCount + 1); // finish_list.comp writes both

GroupList::GroupList(const gpu::Device& device)
    : device_(device), list_groups_(make_plain_kernel(device, KernelId::kListGroups, sizeof(shared::ListGroupsParams))),
      finish_(make_plain_kernel(device, KernelId::kFinishList, sizeof(shared::FinishListParams))) {}

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

void GroupList::clear(gpu::CommandRecorder& recorder) const {
    recorder.fill(flags_, 0);
    recorder.fill(list_, 0, 0, shared::kGroupListFirst * sizeof(std::uint32_t));
}

void GroupList::record(gpu::CommandRecorder& recorder, std::uint32_t width_px) const {
    const shared::ListGroupsParams params{flags_.address(), list_.address(), width_px, group_count_};
    recorder.dispatch(list_groups_, {}, params, linear_groups(group_count_));
    recorder.barrier();
    recorder.dispatch(finish_, {}, shared::FinishListParams{list_.address(), shared::kGroupListCount, 1}, {});
}

} // namespace fieldcast::render
