// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/guard_band.h"
#include "core/render/views/grid_renderer.h"

namespace fieldcast::render {

// Values that a channel determines once, when it starts.

/// Guard band for the scene in its current pose (docs/lightfield.md). Traces the depth of a widened source at reduced
/// size and calls choose_guard_band. The band is in pixels of `source`, the camera of lattice position (0, 0). Several
/// sources get no band, because each covers the area beyond the others' borders.
GuardBandChoice measure_guard_band(const gpu::Device& device, const scene::GpuScene& scene, const Camera& source,
                                   const ViewGrid& largest,
                                   std::span<const LatticePosition> source_positions = kMiddleSource);

/// Exposure that brings the log-average luminance of the source view to 0.18.
float auto_exposure(GridRenderer& grid_renderer, const SourcePlanes& source);

/// The source camera of `camera`'s rigid pose and field of view, in the scene's current pose.
Camera source_camera(const scene::GpuScene& scene, const scene::CameraNode& camera, std::uint32_t width_px,
                     std::uint32_t height_px);

} // namespace fieldcast::render
