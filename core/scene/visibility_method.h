// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"

#include <cstdint>
#include <string>

namespace fieldcast::scene {

/// How the visibility of views is found: by rays, by a rasteriser that draws the triangles into each view, or by the one
/// that should be faster for these views of this scene. Sources are always traced, so that clients that rebuild their
/// surfaces get the same bits.
enum class VisibilityMethod : std::uint8_t { kRays, kRaster, kFaster };

/// Reads "rays" | "raster" | "auto": kFaster on a CPU, rays elsewhere (docs/decisions/0015-views-are-drawn.md). Throws
/// UserError if the device does not support the method `asked` for.
VisibilityMethod choose_visibility(const gpu::Device& device, const std::string& asked);

} // namespace fieldcast::scene
