// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/wire/frame_assembler.h"

// What a frame header announces, checked against the limits; nothing is allocated for pixels here.
namespace fieldcast::wire {

/// A plane of the frame: what the header announced, and the pixels once the first strip has arrived.
struct Part {
    PlaneSemantic semantic = PlaneSemantic::kColour;
    PlaneFormat format = PlaneFormat::kRgb8;
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    Codec codec = Codec::kZstdFiltered;
    std::uint32_t next_row = 0; ///< rows above have been received
    Plane plane{};
};

/// The planes of a source frame.
Decoded<std::vector<Part>> parts_of_planes(const v1::PlanesHeader& message, const FrameHeader& header,
                                           const FrameLimits& limits);

/// The views of `set`, row-major.
Decoded<std::vector<Part>> parts_of_views(const v1::ViewsHeader& message, const ViewSet& set,
                                          const FrameLimits& limits);

/// One entry per view of `set`.
Decoded<std::vector<DiscardCounts>> discards_from_proto(const v1::FrameTrailer& message, const ViewSet& set);

} // namespace fieldcast::wire
