// SPDX-License-Identifier: Apache-2.0
#include "core/render/view_history.h"

#include <algorithm>

namespace fieldcast::render {

namespace {

/// Room for one more in `kept`.
template <class T> void forget_oldest(std::vector<std::unique_ptr<T>>& kept) {
    constexpr std::size_t kMaxKept = 4;
    if (kept.size() == kMaxKept) {
        kept.erase(std::ranges::min_element(kept, {}, [](const auto& one) { return one->last_use; }));
    }
}

/// Index of `position` among `positions`, which gets it if it is not there.
std::uint32_t index_of(std::vector<LatticePosition>& positions, LatticePosition position) {
    const auto found = std::ranges::find(positions, position);
    const auto index = static_cast<std::uint32_t>(found - positions.begin());
    if (found == positions.end()) {
        positions.push_back(position);
    }
    return index;
}

} // namespace

HistoryOfHoles& ViewHistories::holes(const ViewRequest& request) {
    auto found = std::ranges::find_if(holes_, [&](const auto& kept) { return kept->request == request; });
    if (found == holes_.end()) {
        forget_oldest(holes_);
        holes_.push_back(std::make_unique<HistoryOfHoles>());
        found = holes_.end() - 1;
        (*found)->request = request;
    }
    (*found)->last_use = ++use_count_;
    return **found;
}

// A filter holds much memory: one that no frame used for a while goes.
ViewFilter& ViewHistories::filter(const ViewRequest& request) {
    constexpr std::uint64_t kForgottenAfter = 64; // uses of other views
    std::erase_if(filters_, [&](const auto& kept) { return use_count_ - kept->last_use > kForgottenAfter; });
    ViewRequest kind = request;
    kind.positions.clear();
    auto found = std::ranges::find_if(filters_, [&](const auto& kept) { return kept->kind == kind; });
    if (found == filters_.end()) {
        forget_oldest(filters_);
        filters_.push_back(std::make_unique<Filter>(device_, scene_, std::move(kind)));
        found = filters_.end() - 1;
    }
    (*found)->last_use = ++use_count_;
    return (*found)->filter;
}

std::vector<std::uint32_t> choose_corners(const HoleFilling& holes, std::vector<LatticePosition>& positions) {
    if (holes.cascade_rows == 0 || holes.cascade_cols == 0) {
        return {};
    }
    ViewGrid grid;
    grid.rows = holes.cascade_rows;
    grid.cols = holes.cascade_cols;
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t row : {0U, grid.rows - 1}) {
        for (const std::uint32_t col : {0U, grid.cols - 1}) {
            const std::uint32_t index = index_of(positions, lattice_position(grid, row, col));
            if (std::ranges::find(corners, index) == corners.end()) {
                corners.push_back(index);
            }
        }
    }
    return corners;
}

} // namespace fieldcast::render
