// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/wire/encode.h"

#include <chrono>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace fieldcast::feed {

/// Source planes, for a client that makes its own views.
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

/// Content that one client wants of every frame.
using Selection = std::variant<PlaneSelection, ViewSelection>;

/// Kind of strips that a client can decode, depending on the key frame that strips refer to.
enum class KeyNeed : std::uint8_t {
    kNone,  ///< any: it has the key frame
    kAlone, ///< strips that stand alone, always: it keeps no key frames
    kKey,   ///< strips that stand alone until the next key frame, which may come early
};

/// Views of one format that at least one client wants.
struct ViewDemand {
    wire::ViewFormat format;
    std::vector<LatticePosition> positions; ///< sorted, each once
};

/// The union of selections: what the next frame has to contain.
struct Demand {
    std::vector<wire::PlaneChoice> planes; ///< each once
    std::vector<ViewDemand> views;         ///< each format once
    std::uint64_t asked_views = 0;         ///< sum over all selections; shared views count once per selection
    bool needs_alone = false;              ///< a client lacks the key frame
    bool needs_key = false;                ///< a client lacks the key frame and would keep one
    bool is_awaited = false; ///< a client wants a frame soon: the source is rendered meanwhile, so its history settles
    std::chrono::steady_clock::time_point begun{}; ///< when the frame begins

    bool empty() const { return planes.empty() && views.empty(); }
    std::uint64_t view_pixels() const;     ///< sum over all views, once per encoding
    std::uint64_t repeated_planes() const; ///< encodings of planes, not counting the first one of each plane
};

/// Adds `selection` to `demand`.
void add(Demand& demand, const Selection& selection);
void add(Demand& demand, KeyNeed need);

/// Whether `selections` together contain everything in `selection`.
bool covers(const std::vector<Selection>& selections, const Selection& selection);

/// Text for people: "views 3x3 of 160x90 zstd", "planes diffuse jpeg 75, specular jpeg 75".
std::string to_text(const Selection& selection);

/// The word of flags and messages: "raw", "zstd", "jpeg 75".
std::string to_text(const codec::Encoding& encoding);

} // namespace fieldcast::feed
