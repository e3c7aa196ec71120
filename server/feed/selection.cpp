// SPDX-License-Identifier: Apache-2.0
#include "server/feed/selection.h"

#include <algorithm>
#include <set>

namespace fieldcast::feed {

namespace {

void add(Demand& demand, const PlaneSelection& selection) {
    for (const wire::PlaneChoice& choice : selection.choices) {
        if (std::ranges::find(demand.planes, choice) == demand.planes.end()) {
            demand.planes.push_back(choice);
        }
    }
}

void add(Demand& demand, const ViewSelection& selection) {
    auto views = std::ranges::find(demand.views, selection.format, &ViewDemand::format);
    if (views == demand.views.end()) {
        views = demand.views.insert(views, ViewDemand{.format = selection.format, .positions = {}});
    }
    const std::vector<LatticePosition> wanted = lattice_positions(selection.grid);
    demand.asked_views += wanted.size();
    views->positions.insert(views->positions.end(), wanted.begin(), wanted.end());
    std::ranges::sort(views->positions);
    const auto repeated = std::ranges::unique(views->positions);
    views->positions.erase(repeated.begin(), repeated.end());
}

} // namespace

void add(Demand& demand, const Selection& selection) {
    std::visit([&](const auto& kind) { add(demand, kind); }, selection);
}

void add(Demand& demand, KeyNeed need) {
    demand.needs_alone = demand.needs_alone || need != KeyNeed::kNone;
    demand.needs_key = demand.needs_key || need == KeyNeed::kKey;
}

bool covers(const std::vector<Selection>& selections, const Selection& selection) {
    Demand together;
    for (const Selection& one : selections) {
        add(together, one);
    }
    if (const auto* planes = std::get_if<PlaneSelection>(&selection)) {
        return std::ranges::all_of(planes->choices, [&](const wire::PlaneChoice& choice) {
            return std::ranges::find(together.planes, choice) != together.planes.end();
        });
    }
    const auto& views = std::get<ViewSelection>(selection);
    const auto same = std::ranges::find(together.views, views.format, &ViewDemand::format);
    return same != together.views.end() &&
           std::ranges::all_of(lattice_positions(views.grid), [&](LatticePosition position) {
               return std::ranges::binary_search(same->positions, position);
           });
}

std::uint64_t Demand::repeated_planes() const {
    std::set<PlaneSemantic> semantics;
    for (const wire::PlaneChoice& choice : planes) {
        semantics.insert(choice.semantic);
    }
    return planes.size() - semantics.size();
}

std::uint64_t Demand::view_pixels() const {
    std::uint64_t pixels = 0;
    for (const ViewDemand& set : views) {
        pixels += static_cast<std::uint64_t>(set.format.width_px) * set.format.height_px * set.positions.size();
    }
    return pixels;
}

} // namespace fieldcast::feed
