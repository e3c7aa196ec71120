// SPDX-License-Identifier: Apache-2.0
#include "server/feed/encoded_frame.h"

#include <algorithm>

namespace fieldcast::feed {

namespace {

bool covers(const EncodedFrame& frame, const PlaneSelection& selection) {
    return frame.source.has_value() && std::ranges::all_of(selection.choices, [&](const wire::PlaneChoice& choice) {
               return frame.source->find(choice) != nullptr;
           });
}

bool covers(const EncodedFrame& frame, const ViewSelection& selection) {
    const wire::EncodedViews* const views = find_views(frame, selection.format);
    return views != nullptr && std::ranges::all_of(lattice_positions(selection.grid), [&](LatticePosition position) {
               return views->views.contains(position);
           });
}

bool stands_alone(const EncodedFrame& frame, const PlaneSelection& selection) {
    return std::ranges::all_of(
        selection.choices, [&](const wire::PlaneChoice& choice) { return frame.source->find(choice)->stands_alone(); });
}

bool stands_alone(const EncodedFrame& frame, const ViewSelection& selection) {
    const wire::EncodedViews& views = *find_views(frame, selection.format);
    return std::ranges::all_of(lattice_positions(selection.grid),
                               [&](LatticePosition position) { return views.views.at(position).image.stands_alone(); });
}

} // namespace

const wire::EncodedViews* find_views(const EncodedFrame& frame, const wire::ViewFormat& format) {
    const auto found = std::ranges::find(frame.views, format, &wire::EncodedViews::format);
    return found == frame.views.end() ? nullptr : &*found;
}

bool covers(const EncodedFrame& frame, const Selection& selection) {
    return std::visit([&](const auto& kind) { return covers(frame, kind); }, selection);
}

bool stands_alone(const EncodedFrame& frame, const Selection& selection) {
    return std::visit([&](const auto& kind) { return stands_alone(frame, kind); }, selection);
}

} // namespace fieldcast::feed
