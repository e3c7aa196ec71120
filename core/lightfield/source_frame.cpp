// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/source_frame.h"

#include <algorithm>

namespace fieldcast {

const Plane* SourceFrame::find(PlaneSemantic semantic) const {
    const auto found = std::ranges::find(planes, semantic, &Plane::semantic);
    return found == planes.end() ? nullptr : &*found;
}

} // namespace fieldcast
