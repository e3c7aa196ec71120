// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/parallel.h"
#include "core/codec/plane_codec.h"
#include "core/lightfield/views.h"

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

// Planes are encoded once per frame, plane and codec, views once per frame and lattice position. All clients of a
// channel share the results.
//
//     // the planes that any client wants
//     auto source = encode_source(frame, {{kDiffuse, {kZstdFiltered}}, {kDepth, {kRaw}}}, {}, pool);
//     // the views of all grids
//     auto views = encode_views(rendered_union, view_format, {}, pool);
//
// Both results are immutable; keep them in a shared_ptr. `chunks.h` makes a client's frame from them without copying.
namespace fieldcast::wire {

using SharedBytes = std::shared_ptr<const std::vector<std::byte>>;

/// Immutable bytes, from which any number of clients may send.
struct StripBytes {
    SharedBytes bytes;        ///< null: this form does not exist
    std::uint32_t crc32c = 0; ///< of `bytes`
};

/// One encoded strip.
struct EncodedStrip {
    codec::RowBand band;
    StripBytes best{};  ///< may refer to the key frame
    StripBytes alone{}; ///< refers to nothing; shares the bytes of `best` if that does not either; may be absent
};

/// One plane or one view, encoded.
struct EncodedPlane {
    PlaneSemantic semantic = PlaneSemantic::kColour;
    PlaneFormat format = PlaneFormat::kRgb8;
    codec::Encoding encoding{};
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    std::vector<EncodedStrip> strips; ///< from the top, without gaps

    std::uint64_t encoded_bytes() const; ///< of the best form
    bool stands_alone() const;           ///< every strip has a form that refers to nothing
};

/// The key frame of a group, to which strips of the group may refer. Receivers keep the last key frame.
struct KeyFrame {
    std::uint64_t frame_id = 0;          ///< of the key frame; may be the frame itself; 0: no key frame
    const SourceFrame* source = nullptr; ///< null: strips of planes refer to nothing
    const Views* views = nullptr;        ///< null: strips of views refer to nothing
    bool is_optional = false;            ///< strips that refer to it are also encoded to stand alone
};

/// A plane with its encoding and format.
struct PlaneChoice {
    PlaneSemantic semantic = PlaneSemantic::kColour;
    codec::Encoding encoding{};
    std::optional<PlaneFormat> format{}; ///< empty: usual_format(); never set to the usual format itself

    auto operator<=>(const PlaneChoice&) const = default;
};

/// The format in which the plane is sent.
PlaneFormat format_of(const PlaneChoice& choice);

/// A source frame in every form that a client has chosen.
struct EncodedSource {
    FrameHeader header;
    std::uint64_t key_frame_id = 0;   ///< of the frame to which best forms of strips may refer; see KeyFrame
    std::vector<EncodedPlane> planes; ///< at most one per PlaneChoice
    std::chrono::nanoseconds encode_time{0};

    const EncodedPlane* find(PlaneChoice choice) const; ///< null if absent
};

/// Encodes the planes of `choices`, duplicates once. Planes that are sent in another format than the frame's are
/// converted first. `frame` must have every chosen plane (FC_ASSERT).
EncodedSource encode_source(const SourceFrame& frame, std::span<const PlaneChoice> choices, const KeyFrame& key,
                            WorkerPool& pool);

/// Clients with equal ViewFormat are sent views from the same EncodedViews. The anchors of their grids may differ,
/// because half steps are part of the lattice position.
struct ViewFormat {
    LatticeGeometry geometry;
    float fovy_rad = 1.0F; ///< vertical, over height_px
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    codec::Encoding encoding{};

    bool operator==(const ViewFormat&) const = default;
};

/// One encoded view.
struct EncodedView {
    EncodedPlane image;
    DiscardCounts discards;
};

/// The union of the views of all clients with one ViewFormat, by lattice position.
struct EncodedViews {
    FrameHeader header;
    ViewFormat format;
    std::uint64_t key_frame_id = 0; ///< as in EncodedSource
    std::map<LatticePosition, EncodedView> views;
    std::chrono::nanoseconds encode_time{0};
};

/// Encodes each view once. Every image must have the size in `format`.
EncodedViews encode_views(const Views& views, const ViewFormat& format, const KeyFrame& key, WorkerPool& pool);

} // namespace fieldcast::wire
