// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/parallel.h"
#include "core/codec/plane_codec.h"
#include "core/lightfield/views.h"

#include <chrono>
#include <map>
#include <memory>
#include <span>
#include <vector>

// Encoding: once per frame, plane and codec, once per view; shared by all clients of a channel.
//
//     auto source = encode_source(frame, {{kDiffuse, {kZstdFiltered}}, {kDepth, {kRaw}}}, {}, pool); // what all want
//     auto views = encode_views(rendered_union, view_format, {}, pool); // of all grids
//
// Both results are immutable; keep them in a shared_ptr. `chunks.h` makes a client's frame from them without copying.
namespace fieldcast::wire {

using SharedBytes = std::shared_ptr<const std::vector<std::byte>>;

/// Bytes that never change, so that any number of clients may send from them.
struct StripBytes {
    SharedBytes bytes;        ///< null: none
    std::uint32_t crc32c = 0; ///< of `bytes`
};

/// One encoded strip.
struct EncodedStrip {
    codec::RowBand band;
    StripBytes best{};  ///< may refer to the key frame
    StripBytes alone{}; ///< refers to nothing; shares the bytes of `best` where that does neither; may be absent
};

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

/// What strips may refer to: the key frame of their group. Receivers keep key frames.
struct KeyFrame {
    std::uint64_t frame_id = 0;          ///< of the key frame; may be the frame itself. 0: there is none
    const SourceFrame* source = nullptr; ///< null: strips of planes refer to nothing
    const Views* views = nullptr;        ///< null: strips of views refer to nothing
    bool is_optional = false;            ///< strips that refer to it are also encoded to stand alone
};

/// A plane and how to encode it.
struct PlaneChoice {
    PlaneSemantic semantic = PlaneSemantic::kColour;
    codec::Encoding encoding{};
    std::optional<PlaneFormat> format{}; ///< empty: usual_format(); never names that

    auto operator<=>(const PlaneChoice&) const = default;
};

/// The format in which such planes are sent.
PlaneFormat format_of(const PlaneChoice& choice);

/// A source frame in every form that some client wants.
struct EncodedSource {
    FrameHeader header;
    std::uint64_t key_frame_id = 0;   ///< what the best form of strips refers to; see KeyFrame
    std::vector<EncodedPlane> planes; ///< at most one per PlaneChoice
    std::chrono::nanoseconds encode_time{0};

    const EncodedPlane* find(PlaneChoice choice) const; ///< null if absent
};

/// Encodes the planes named in `choices` (twice named: once encoded), those of another format than the frame's
/// converted before. A plane that the frame lacks is our bug.
EncodedSource encode_source(const SourceFrame& frame, std::span<const PlaneChoice> choices, const KeyFrame& key,
                            WorkerPool& pool);

/// What views must have in common to be shared: clients with equal ViewFormat send from the same EncodedViews.
/// Anchors need no mention: half steps are part of the lattice position.
struct ViewFormat {
    LatticeGeometry geometry;
    float fovy_rad = 1.0F; ///< vertical, over height_px
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    codec::Encoding encoding{};

    bool operator==(const ViewFormat&) const = default;
};

struct EncodedView {
    EncodedPlane image;
    DiscardCounts discards;
};

/// The union of all views that clients of one ViewFormat want, by lattice position.
struct EncodedViews {
    FrameHeader header;
    ViewFormat format;
    std::uint64_t key_frame_id = 0; ///< as of EncodedSource
    std::map<LatticePosition, EncodedView> views;
    std::chrono::nanoseconds encode_time{0};
};

/// Encodes each view once. Every image must have the size in `format`.
EncodedViews encode_views(const Views& views, const ViewFormat& format, const KeyFrame& key, WorkerPool& pool);

} // namespace fieldcast::wire
