// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"
#include "core/scene/gpu_scene.h"

namespace fieldcast::scene {

Traversal choose_traversal(const gpu::Device& device, const std::string& wish) {
    if (wish == "bvh") {
        return Traversal::kBvh;
    }
    if (wish == "rayquery") {
        if (!device.info().has_ray_query) {
            throw UserError("--traversal rayquery: " + device.info().name +
                            " has no VK_KHR_ray_query; use bvh or auto");
        }
        return Traversal::kRayQuery;
    }
    if (wish != "auto") {
        throw UserError("--traversal " + wish + ": expected auto, bvh or rayquery");
    }
    return device.info().is_cpu || !device.info().has_ray_query ? Traversal::kBvh : Traversal::kRayQuery;
}

VisibilityMethod choose_visibility(const gpu::Device& device, const std::string& wish) {
    if (wish == "rays") {
        return VisibilityMethod::kRays;
    }
    if (wish == "raster") {
        if (!device.info().has_rasteriser) {
            throw UserError("--visibility raster: " + device.info().name + " has no depth buffers of floats, or no independentBlend; use rays or auto");
        }
        return VisibilityMethod::kRaster;
    }
    if (wish != "auto") {
        throw UserError("--visibility " + wish + ": expected auto, rays or raster");
    }
    const bool may_draw = device.info().is_cpu && device.info().has_rasteriser;
    return may_draw ? VisibilityMethod::kFaster : VisibilityMethod::kRays;
}

} // namespace fieldcast::scene
