// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/views.h"
#include "core/render/source/source_planes.h"
#include "core/render/view_request.h"
#include "core/render/views/hole_filler.h"
#include "core/scene/gpu_scene.h"

#include <memory>
#include <span>

namespace fieldcast::render {

/// Linear radiance of one view, for measuring: row-major RGB, unexposed.
struct LinearView {
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    std::vector<glm::vec3> pixels;
};

/// Makes finished views from a source frame and the scene: visibility of all views, backward reprojection of the
/// illumination with footprint-scaled tests, path tracing of what was discarded and could not be had otherwise
/// (HoleFiller), averages and denoiser of the views where the settings ask for them (ViewFilter), remodulation with the
/// target's own material, tone mapping. The same class on server and clients.
class GridRenderer {
public:
    GridRenderer(const gpu::Device& device, const scene::GpuScene& scene);
    ~GridRenderer();

    /// Views in the order of `request.positions`; the result's header is the source's with the stage times of this call
    /// appended. The scene must be posed for the source's scene time. Throws UserError if the views are to be filtered
    /// and are more than the device has room for.
    Views render(const SourcePlanes& source, const ViewRequest& request);

    /// Bytes of the device's memory per pixel of views: what they take while they are made, and what is kept of them.
    static std::uint64_t bytes_per_pixel(const RenderSettings& settings);

    /// What render() would have to allocate for `request`; 0: nothing.
    std::uint64_t missing_bytes(const RenderSettings& settings, const ViewRequest& request) const;

    /// Gives back what is kept of views of other geometries, fields of view and sizes than those of `requests`, and room
    /// for more pixels than they have. Nothing of the last render() can be asked any more.
    void forget_all_but(std::span<const ViewRequest> requests);

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
