// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/guard_band.h"
#include "core/render/views/grid_renderer.h"

namespace fieldcast::render {

/// What a channel decides once, when it starts.

/// Guard band for the scene as posed now (docs/lightfield.md): traces the depth of a widened source at reduced
/// size and asks choose_guard_band. The band is in pixels of `source`, the camera of lattice position (0, 0). Several
/// sources get none: each shows what lies beyond the others' borders.
GuardBandChoice measure_guard_band(const gpu::Device& device, const scene::GpuScene& scene, const Camera& source,
                                   const ViewGrid& largest,
                                   std::span<const LatticePosition> source_positions = kMiddleSource);

/// Exposure that brings the log-average luminance of the source view to 0.18.
float auto_exposure(GridRenderer& grid_renderer, const SourcePlanes& source);

/// The rigid pose of `camera` in the scene's current pose.
Camera source_camera(const scene::GpuScene& scene, const scene::CameraNode& camera, std::uint32_t width_px,
                     std::uint32_t height_px);

} // namespace fieldcast::render
