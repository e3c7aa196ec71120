// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/vocabulary.h"

namespace fieldcast {

std::vector<PlaneSemantic> planes_of(DeliveryMode mode, PlaneSet set, std::span<const WarpPlane> extra) {
    std::vector<PlaneSemantic> planes;
    const auto add = [&planes](std::span<const PlaneSemantic> more) {
        planes.insert(planes.end(), more.begin(), more.end());
    };
    add(row_of(mode).planes);
    switch (mode) {
    case DeliveryMode::kViews:
        break;
    case DeliveryMode::kScene:
        add(row_of(set).planes);
        break;
    case DeliveryMode::kWarp:
        for (const WarpPlane plane : extra) {
            add(row_of(plane).planes);
        }
        break;
    }
    return planes;
}

} // namespace fieldcast
