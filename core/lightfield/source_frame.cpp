// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/source_frame.h"

#include <algorithm>

namespace fieldcast {

const Plane* SourceFrame::find(PlaneSemantic semantic) const {
    const auto found = std::ranges::find(planes, semantic, &Plane::semantic);
    return found == planes.end() ? nullptr : &*found;
}

std::uint32_t plane_height(const FrameHeader& header, PlaneSemantic semantic) {
    const bool has_pages = semantic == PlaneSemantic::kDiffuse || semantic == PlaneSemantic::kSpecular;
    return with_guard_band(header.source, header.guard_band).height_px * (has_pages ? 1 + header.layer_count : 1);
}

} // namespace fieldcast
