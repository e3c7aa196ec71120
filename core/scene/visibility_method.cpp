// SPDX-License-Identifier: Apache-2.0
#include "core/scene/visibility_method.h"

#include "core/base/error.h"

namespace fieldcast::scene {

VisibilityMethod choose_visibility(const gpu::Device& device, const std::string& asked) {
    if (asked == "rays") {
        return VisibilityMethod::kRays;
    }
    if (asked == "raster") {
        if (!device.info().has_rasteriser) {
            throw UserError("--visibility raster: " + device.info().name +
                            " lacks floating-point depth buffers or independentBlend; use rays or auto");
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
