// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/views.h"
#include "core/render/hole_filler.h"
#include "core/render/source_planes.h"
#include "core/scene/gpu_scene.h"

#include <memory>

namespace fieldcast::render {

/// Which views to make. All share geometry, field of view and size, so that they are one batch.
struct ViewRequest {
    LatticeGeometry geometry;
    float fovy_rad = 0.785398F; ///< ≤ the source's
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0; ///< ≤ the source's
    std::vector<LatticePosition> positions;

    bool operator==(const ViewRequest&) const = default;
};

/// Linear radiance of one view, for measuring: row-major RGB, unexposed.
struct LinearView {
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    std::vector<glm::vec3> pixels;
};

/// Makes finished views from a source frame and the scene: visibility of all views, backward reprojection of the
/// illumination with footprint-scaled tests, remodulation with the target's own material, path tracing of what was
/// discarded and could not be had otherwise (HoleFiller), tone mapping. The same class on server and clients.
class GridRenderer {
public:
    GridRenderer(const gpu::Device& device, const scene::GpuScene& scene);
    ~GridRenderer();

    /// Views in the order of `request.positions`; the result's header is the source's with the stage times of this call
    /// appended. The scene must be posed for the source's scene time.
    Views render(const SourcePlanes& source, const ViewRequest& request);

    /// Linear image of view `index` of the last render().
    LinearView linear_view(std::size_t index) const;

    /// View depth (metres, infinity: nothing) of view `index` of the last render(), for tests and benchmarks.
    std::vector<float> view_depth(std::size_t index) const;

    /// Instance that each pixel of view `index` of the last render() shows, scene::kNone: nothing; for benchmarks.
    std::vector<std::uint32_t> view_instances(std::size_t index) const;

    /// Which pixels of view `index` of the last render() the source did not show, row-major.
    std::vector<bool> hole_mask(std::size_t index) const;

    /// Of the last render(), over all views, those of the cascade's corners included.
    HoleCounts hole_counts() const;

    std::uint64_t invalid_sample_count() const; ///< must stay 0

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::render
