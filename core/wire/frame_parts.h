// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "core/lightfield/views.h"
#include "core/wire/frame_limits.h"
#include "core/wire/view_set.h"

#include "fieldcast/v1/frame.pb.h"

#include <cstdint>
#include <vector>

// Reads the parts that a frame header announces and checks them against the limits. Allocates no memory for pixels.
namespace fieldcast::wire {

/// A plane or view of a frame, as its header announced it. It has pixels once its first strip has been decoded.
struct Part {
    PlaneSemantic semantic = PlaneSemantic::kColour;
    PlaneFormat format = PlaneFormat::kRgb8;
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    Codec codec = Codec::kZstdFiltered;
    std::uint32_t next_row = 0; ///< all rows above it have been received
    Plane plane{};
};

/// The planes of a source frame, in the order of the header.
Decoded<std::vector<Part>> parts_of_planes(const v1::PlanesHeader& message, const FrameHeader& header,
                                           const FrameLimits& limits);

/// The views of `set`, row-major.
Decoded<std::vector<Part>> parts_of_views(const v1::ViewsHeader& message, const ViewSet& set,
                                          const FrameLimits& limits);

/// The counts of a frame of views: one entry per view of `set`, row-major.
Decoded<std::vector<DiscardCounts>> discards_from_proto(const v1::FrameTrailer& message, const ViewSet& set);

} // namespace fieldcast::wire
