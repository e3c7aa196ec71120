// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/render/source/source_renderer.h"
#include "core/render/views/grid_renderer.h"
#include "core/render/warp/warp_renderer.h"

namespace fieldcast::render {

/// Makes what clients without the scene need of a frame: the source as a finished image with its guard band, inverse
/// depth, and what the corner views of the largest grid see and the source does not (ResidualLayer). Not thread-safe.
class WarpPlanesRenderer {
public:
    /// `views` renders views as clients of finished views get them.
    WarpPlanesRenderer(const gpu::Device& device, const scene::GpuScene& scene, GridRenderer& views);

    /// Adds planes kColour and kInverseDepth, and with `has_residual` kResidualColour and kResidualInverseDepth, to
    /// `frame`, which has the header of `source`; its header gets what describes them. `source` has one source image.
    void render(const SourcePlanes& source, const ViewGrid& largest, bool has_residual, SourceFrame& frame);

private:
    /// The views whose tiles are sent.
    struct Corners {
        Views views;
        std::vector<std::vector<float>> depth_m;
    };
    Corners render_corners(const SourcePlanes& source, const ViewGrid& largest);
    Plane render_colour(const SourcePlanes& source);
    void add_residual(const Corners& corners, const ViewGrid& largest, SourceFrame& frame);

    const gpu::Device& device_;
    GridRenderer& views_;
    SurfacePlanesRenderer surfaces_;
    SourcePlanes corner_planes_;
    WarpRenderer warp_;
};

/// Corners of `grid` in the order in which their tiles are chosen: opposite ones follow each other, since later views
/// need tiles only for what earlier ones do not show. Without the source's own position (0, 0).
std::vector<LatticePosition> residual_positions(const ViewGrid& grid);

/// Step of inverse depth, 1/m, with which no pixel of a view of `grid` moves by more than 1/64 pixel; at least what 16
/// bits need for `nearest_m`.
float choose_inverse_depth_unit(const Camera& source, const ViewGrid& grid, float nearest_m);

/// Plane of `semantic` from view depth in metres (infinity: nothing), `width_px` pixels to a row.
Plane make_inverse_depth(PlaneSemantic semantic, std::span<const float> depth_m, std::uint32_t width_px, float unit);

} // namespace fieldcast::render
