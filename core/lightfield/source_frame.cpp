// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/source_frame.h"

#include <algorithm>

namespace fieldcast {

const Plane* SourceFrame::find(PlaneSemantic semantic) const {
    const auto found = std::ranges::find(planes, semantic, &Plane::semantic);
    return found == planes.end() ? nullptr : &*found;
}

Camera widened_source(const FrameHeader& header, std::size_t index) {
    const Camera camera = moved_camera(header.source, header.source_geometry, header.source_positions[index]);
    return with_guard_band(camera, header.guard_band);
}

bool is_illumination(PlaneSemantic semantic) {
    return semantic == PlaneSemantic::kDiffuse || semantic == PlaneSemantic::kSpecular ||
           semantic == PlaneSemantic::kTotalLight;
}

std::uint32_t page_count(const FrameHeader& header, PlaneSemantic semantic) {
    return static_cast<std::uint32_t>(header.source_positions.size()) *
           (is_illumination(semantic) ? 1 + header.layer_count : 1);
}

bool is_residual(PlaneSemantic semantic) {
    return semantic == PlaneSemantic::kResidualColour || semantic == PlaneSemantic::kResidualInverseDepth;
}

std::uint32_t plane_width(const FrameHeader& header, PlaneSemantic semantic) {
    return is_residual(semantic) ? kResidualColumns * kResidualTile
                                 : with_guard_band(header.source, header.guard_band).width_px;
}

std::uint32_t plane_height(const FrameHeader& header, PlaneSemantic semantic) {
    if (is_residual(semantic)) {
        return residual_height(header.residual.tiles.size());
    }
    return with_guard_band(header.source, header.guard_band).height_px * page_count(header, semantic);
}

} // namespace fieldcast
