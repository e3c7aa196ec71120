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
//     auto source = encode_source(frame, {{kDiffuse, kZstdFiltered}, {kDepth, kRaw}}, pool);   // union of all wishes
//     auto views = encode_views(rendered_union, view_format, pool);                            // union of all grids
//
// Both results are immutable; keep them in a shared_ptr. `chunks.h` makes a client's frame from them without copying.
namespace fieldcast::wire {

using SharedBytes = std::shared_ptr<const std::vector<std::byte>>;

/// One encoded strip. `bytes` is never changed, so any number of clients may send from it.
struct EncodedStrip {
    codec::RowBand band;
    SharedBytes bytes;
    std::uint32_t crc32c = 0; ///< of `bytes`
};

struct EncodedPlane {
    PlaneSemantic semantic = PlaneSemantic::kColour;
    PlaneFormat format = PlaneFormat::kRgb8;
    codec::CodecId codec = codec::CodecId::kZstdFiltered;
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    std::vector<EncodedStrip> strips; ///< from the top, without gaps

    std::uint64_t encoded_bytes() const;
};

EncodedPlane encode_plane(const Plane& plane, codec::CodecId codec, WorkerPool& pool);

/// A plane and how to encode it.
struct PlaneChoice {
    PlaneSemantic semantic = PlaneSemantic::kColour;
    codec::CodecId codec = codec::CodecId::kZstdFiltered;

    auto operator<=>(const PlaneChoice&) const = default;
};

/// A source frame in every form that some client wants.
struct EncodedSource {
    FrameHeader header;
    std::vector<EncodedPlane> planes; ///< at most one per PlaneChoice
    std::chrono::nanoseconds encode_time{0};

    const EncodedPlane* find(PlaneChoice choice) const; ///< null if absent
};

/// Encodes the planes named in `choices` (twice named: once encoded). A plane that the frame lacks is our bug.
EncodedSource encode_source(const SourceFrame& frame, std::span<const PlaneChoice> choices, WorkerPool& pool);

/// What views must have in common to be shared: clients with equal ViewFormat send from the same EncodedViews.
/// Anchors need no mention: half steps are part of the lattice position.
struct ViewFormat {
    LatticeGeometry geometry;
    float fovy_rad = 1.0F; ///< vertical, over height_px
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    codec::CodecId codec = codec::CodecId::kZstdFiltered;

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
    std::map<LatticePosition, EncodedView> views;
    std::chrono::nanoseconds encode_time{0};
};

/// Encodes each view once. Every image must have the size in `format`.
EncodedViews encode_views(const Views& views, const ViewFormat& format, WorkerPool& pool);

} // namespace fieldcast::wire
