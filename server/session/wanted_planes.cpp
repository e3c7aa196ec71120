// SPDX-License-Identifier: Apache-2.0
#include "server/session/wanted_planes.h"

#include <algorithm>

namespace fieldcast::session {

std::vector<PlaneSemantic> asked_planes(const v1::Configure& wanted, DeliveryMode mode) {
    std::vector<WarpPlane> extra;
    for (const WarpPlane plane : kAll<WarpPlane>) {
        if (std::ranges::find(wanted.warp_planes(), static_cast<int>(plane)) != wanted.warp_planes().end()) {
            extra.push_back(plane);
        }
    }
    const auto set = from_number<PlaneSet>(static_cast<std::uint64_t>(wanted.planes()));
    return planes_of(mode, set.value_or(PlaneSet::kIllumination), extra);
}

const v1::CodecPreference* find_preference(const v1::Configure& wanted, PlaneSemantic semantic) {
    const auto found = std::ranges::find(wanted.codecs(), wire::to_proto(semantic),
                                         [](const v1::CodecPreference& p) { return p.semantic(); });
    return found == wanted.codecs().end() ? nullptr : &*found;
}

} // namespace fieldcast::session
