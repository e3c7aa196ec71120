// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/wire/encode.h"

#include <chrono>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace fieldcast::feed {

/// Source planes, for a client that has the scene.
struct PlaneSelection {
    std::vector<wire::PlaneChoice> choices;

    bool operator==(const PlaneSelection&) const = default;
};

/// Finished views. `grid.geometry` is that of `format`.
struct ViewSelection {
    wire::ViewFormat format;
    ViewGrid grid;

    bool operator==(const ViewSelection&) const = default;
};

/// What one client wants of every frame.
using Selection = std::variant<PlaneSelection, ViewSelection>;

/// What a client without the key frame that strips refer to asks for.
enum class KeyNeed : std::uint8_t {
    kNone,  ///< it has the key frame
    kAlone, ///< strips that stand alone, always: it keeps no key frames
    kKey,   ///< strips that stand alone until the next key frame, which may come early
};

/// Views of one format that somebody wants.
struct ViewDemand {
    wire::ViewFormat format;
    std::vector<LatticePosition> positions; ///< sorted, each once
};

/// The union of selections: what the next frame has to contain.
struct Demand {
    std::vector<wire::PlaneChoice> planes; ///< each once
    std::vector<ViewDemand> views;         ///< each format once
    std::uint64_t asked_views = 0;         ///< over all selections, also those that several have in common
    bool needs_alone = false;              ///< somebody lacks the key frame
    bool needs_key = false;                ///< and would keep one
    bool is_awaited = false; ///< somebody wants a frame soon: until then the source goes on, for the sake of its history
    std::chrono::steady_clock::time_point begun{}; ///< when the frame begins that has all this

    bool empty() const { return planes.empty() && views.empty(); }
    std::uint64_t view_pixels() const;     ///< of all views together, in each of their encodings
    std::uint64_t repeated_planes() const; ///< encodings of planes beyond the first one of each plane
};

/// Widens `demand` so that it covers `selection`.
void add(Demand& demand, const Selection& selection);
void add(Demand& demand, KeyNeed need);

/// Whether a client that gets everything in `selections` has everything in `selection`.
bool covers(const std::vector<Selection>& selections, const Selection& selection);

/// For people: "views 3x3 of 160x90 zstd", "planes diffuse jpeg 75, specular jpeg 75".
std::string to_text(const Selection& selection);

/// The word of flags and texts: "raw", "zstd", "jpeg 75".
std::string to_text(const codec::Encoding& encoding);

} // namespace fieldcast::feed
