// SPDX-License-Identifier: Apache-2.0
#include "core/render/views/view_history.h"

#include <algorithm>

namespace fieldcast::render {

namespace {

/// The request without positions: geometry, field of view, size and guard band.
ViewRequest kind_of(ViewRequest request) {
    request.positions.clear();
    return request;
}

/// Erases the least recently used element if `kept` is full, so that one more fits.
template <class T> void forget_oldest(std::vector<std::unique_ptr<T>>& kept) {
    constexpr std::size_t kMaxKept = 4;
    if (kept.size() == kMaxKept) {
        kept.erase(std::ranges::min_element(kept, {}, [](const auto& one) { return one->last_use; }));
    }
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

// A filter holds much memory, so an unused one is erased after kForgottenAfter uses of other views.
ViewFilter& ViewHistories::filter(const ViewRequest& request) {
    constexpr std::uint64_t kForgottenAfter = 64; // uses of other views
    std::erase_if(filters_, [&](const auto& kept) { return use_count_ - kept->last_use > kForgottenAfter; });
    ViewRequest kind = kind_of(request);
    auto found = std::ranges::find_if(filters_, [&](const auto& kept) { return kept->kind == kind; });
    if (found == filters_.end()) {
        forget_oldest(filters_);
        filters_.push_back(std::make_unique<Filter>(device_, scene_, std::move(kind)));
        found = filters_.end() - 1;
    }
    (*found)->last_use = ++use_count_;
    return (*found)->filter;
}

std::uint64_t ViewHistories::missing_pixels(const ViewRequest& request) const {
    const std::uint64_t pixels = std::uint64_t{request.width_px} * request.height_px * request.positions.size();
    const auto found = std::ranges::find(filters_, kind_of(request), [](const auto& kept) { return kept->kind; });
    const std::uint64_t has = found == filters_.end() ? 0 : (*found)->filter.texel_count();
    return pixels - std::min(pixels, has);
}

void ViewHistories::forget_all_but(std::span<const ViewRequest> requests) {
    const auto is_wanted = [&](const ViewRequest& kind) {
        return std::ranges::any_of(requests, [&](const ViewRequest& wanted) { return kind_of(wanted) == kind; });
    };
    std::erase_if(holes_, [&](const auto& kept) { return !is_wanted(kind_of(kept->request)); });
    std::erase_if(filters_, [&](const auto& kept) { return !is_wanted(kept->kind); });
}

} // namespace fieldcast::render
