// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/readback.h"
#include "core/render/source/source_renderer.h"
#include "core/render/views/grid_renderer.h"
#include "core/render/warp/warp_renderer.h"

namespace fieldcast::render {

/// Makes the planes from which clients without the scene warp views: the source as a finished image with its guard
/// band, its inverse depth, and the parts of the largest grid's corner views that the source does not show
/// (ResidualLayer). Not thread-safe.
class WarpPlanesRenderer {
public:
    /// `views` renders the source image and the corner views; it must outlive this object.
    WarpPlanesRenderer(const gpu::Device& device, const scene::GpuScene& scene, GridRenderer& views);

    /// Adds planes to `frame`: kColour and kInverseDepth, and with `has_residual` kResidualColour and
    /// kResidualInverseDepth. Sets their parameters in its header, which must be that of `source`. `source` must have
    /// one source image. Blocks. Throws VulkanError.
    void render(const SourcePlanes& source, const ViewGrid& largest, bool has_residual, SourceFrame& frame);

private:
    /// The views whose tiles are sent.
    struct Corners {
        Views views;
        std::vector<std::vector<float>> depth_m; ///< of each view, row-major
    };
    Corners render_corners(const SourcePlanes& source, const ViewGrid& largest);
    std::vector<float> download_depth(const SourcePlanes& source, Corners& corners);
    Plane render_colour(const SourcePlanes& source);
    void add_residual(const Corners& corners, const ViewGrid& largest, SourceFrame& frame);

    gpu::Readback readback_;
    GridRenderer& views_;
    SurfacePlanesRenderer surfaces_;
    SourcePlanes corner_planes_;
    WarpRenderer warp_;
};

/// Corners of `grid` in the order in which their tiles are chosen, without the source's own position (0, 0). Opposite
/// corners follow each other, because later views need tiles only for what earlier views do not show.
std::vector<LatticePosition> residual_positions(const ViewGrid& grid);

/// Step of inverse depth in 1/m. Rounding to it moves no pixel of a view of `grid` by more than 1/64 pixel, unless 16
/// bits need a larger step for the depth `nearest_m` (metres).
float choose_inverse_depth_unit(const Camera& source, const ViewGrid& grid, float nearest_m);

/// Plane of `semantic` from view depth in metres (infinity: nothing), row-major with `width_px` pixels per row. `unit`
/// is the step of inverse depth in 1/m.
Plane make_inverse_depth(PlaneSemantic semantic, std::span<const float> depth_m, std::uint32_t width_px, float unit);

} // namespace fieldcast::render
