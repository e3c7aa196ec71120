// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"
#include "core/scene/gpu_scene.h"

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

VisibilityMethod choose_visibility(const gpu::Device& device, const std::string& asked) {
    if (asked == "rays") {
        return VisibilityMethod::kRays;
    }
    if (asked == "raster") {
        if (!device.info().has_rasteriser) {
            throw UserError("--visibility raster: " + device.info().name + " has no depth buffers of floats, or no independentBlend; use rays or auto");
        }
        return VisibilityMethod::kRaster;
    }
    if (asked != "auto") {
        throw UserError("--visibility " + asked + ": expected auto, rays or raster");
    }
    const bool may_draw = device.info().is_cpu && device.info().has_rasteriser;
    return may_draw ? VisibilityMethod::kFaster : VisibilityMethod::kRays;
}

} // namespace fieldcast::scene
