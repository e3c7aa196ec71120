// SPDX-License-Identifier: Apache-2.0
#include "core/scene/traversal.h"

#include "core/base/error.h"

namespace fieldcast::scene {

Traversal choose_traversal(const gpu::Device& device, const std::string& asked) {
    if (asked == "bvh") {
        return Traversal::kBvh;
    }
    if (asked == "rayquery") {
        if (!device.info().has_ray_query) {
            throw UserError("--traversal rayquery: " + device.info().name +
                            " has no VK_KHR_ray_query; use bvh or auto");
        }
        return Traversal::kRayQuery;
    }
    if (asked != "auto") {
        throw UserError("--traversal " + asked + ": expected auto, bvh or rayquery");
    }
    return device.info().is_cpu || !device.info().has_ray_query ? Traversal::kBvh : Traversal::kRayQuery;
}

} // namespace fieldcast::scene
