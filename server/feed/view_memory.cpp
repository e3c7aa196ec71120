// SPDX-License-Identifier: Apache-2.0
#include "server/feed/view_memory.h"

#include <algorithm>

namespace fieldcast::feed {

namespace {

constexpr std::uint64_t kCornerViews = 4; ///< views that the renderer may add to a set to fill holes

std::vector<ViewDemand> without_encoding(const Demand& demand) {
    std::vector<ViewDemand> sets;
    for (const ViewDemand& views : demand.views) {
        wire::ViewFormat kind = views.format;
        kind.encoding = {};
        auto set = std::ranges::find(sets, kind, &ViewDemand::format);
        if (set == sets.end()) {
            set = sets.insert(sets.end(), ViewDemand{.format = kind, .positions = {}});
        }
        std::vector<LatticePosition> both;
        std::ranges::set_union(set->positions, views.positions, std::back_inserter(both));
        set->positions = std::move(both);
    }
    return sets;
}

/// Every set of both lists; of equal formats, the one with more positions.
std::vector<ViewDemand> larger(std::vector<ViewDemand> sets, const std::vector<ViewDemand>& others) {
    for (const ViewDemand& other : others) {
        const auto same = std::ranges::find(sets, other.format, &ViewDemand::format);
        if (same == sets.end()) {
            sets.push_back(other);
        } else if (same->positions.size() < other.positions.size()) {
            same->positions = other.positions;
        }
    }
    return sets;
}

} // namespace

bool ViewMemory::take(std::uint64_t bytes) {
    const std::uint64_t limit = limit_;
    std::uint64_t used = used_;
    do {
        if (bytes > limit || used > limit - bytes) {
            return false;
        }
    } while (!used_.compare_exchange_weak(used, used + bytes));
    return true;
}

HeldViews::~HeldViews() {
    settle({});
    if (memory_ != nullptr) {
        memory_->give_back(bytes_of(held_)); // the views that are still wanted
    }
}

std::uint64_t HeldViews::bytes_of(const std::vector<ViewDemand>& sets) const {
    std::uint64_t pixels = 0;
    for (const ViewDemand& set : sets) {
        pixels += std::uint64_t{set.format.width_px} * set.format.height_px * (set.positions.size() + kCornerViews);
    }
    return pixels * bytes_per_pixel_;
}

std::optional<std::string> HeldViews::want(const Demand& demand) {
    std::vector<ViewDemand> wanted = without_encoding(demand);
    std::vector<ViewDemand> held = larger(held_, wanted);
    const std::uint64_t before = bytes_of(held_);
    const std::uint64_t after = bytes_of(held);
    if (memory_ != nullptr && after > before && !memory_->take(after - before)) {
        return "the views of all clients would need " + std::to_string(after - before) +
               " more bytes of the device's memory; " + std::to_string(memory_->used()) + " of " +
               std::to_string(memory_->limit()) +
               " are in use; unused views are freed after a few seconds; ask for fewer or smaller views";
    }
    wanted_ = std::move(wanted);
    held_ = std::move(held);
    return std::nullopt;
}

void HeldViews::settle(const std::vector<ViewDemand>& kept) {
    std::vector<ViewDemand> held = larger(wanted_, kept);
    const std::uint64_t before = bytes_of(held_);
    const std::uint64_t after = bytes_of(held);
    if (memory_ != nullptr && after < before) {
        memory_->give_back(before - after);
    }
    held_ = std::move(held);
}

} // namespace fieldcast::feed
