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

struct GridRendererState;

/// Linear radiance of one view, for measuring: row-major RGB, unexposed.
struct LinearView {
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    std::vector<glm::vec3> pixels;
};

/// Makes finished views from a source frame and the scene, on server and clients alike. The passes are: visibility of
/// all views, backward reprojection of the illumination with footprint-scaled tests, filling of the discarded pixels
/// (HoleFiller, which traces paths where nothing else helps), averages and denoiser of the views where the settings ask
/// for them (ViewFilter), remodulation with the material of the view's own surface, and tone mapping. Not thread-safe.
class GridRenderer {
public:
    GridRenderer(const gpu::Device& device, const scene::GpuScene& scene);
    ~GridRenderer();

    /// Renders views in the order of `request.positions`. The header of the result is the source's, with the stage
    /// times of this call appended. The scene must be posed for the source's scene time. Blocks. Throws UserError if
    /// the views are filtered and the device has no room for so many, VulkanError if a call fails.
    Views render(const SourcePlanes& source, const ViewRequest& request);

    /// Bytes of device memory per pixel of views, while they are rendered and for what is kept of them. Staging memory
    /// of the host is not counted.
    static std::uint64_t bytes_per_pixel(const RenderSettings& settings);

    /// Bytes of device memory that render() would allocate for `request`.
    std::uint64_t missing_bytes(const RenderSettings& settings, const ViewRequest& request) const;

    /// Frees the history of all views whose geometry, field of view or size is not in `requests`, and the buffers of
    /// the last render(), whose results cannot be read afterwards.
    void forget_all_but(std::span<const ViewRequest> requests);

    /// Linear image of view `index` of the last render().
    LinearView linear_view(std::size_t index) const;

    /// View depth (metres, infinity: nothing) of view `index` of the last render(), for tests and benchmarks.
    std::vector<float> view_depth(std::size_t index) const;

    /// Instance in each pixel of view `index` of the last render(), scene::kNone: nothing; for benchmarks.
    std::vector<std::uint32_t> view_instances(std::size_t index) const;

    /// Pixels of view `index` of the last render() that the source does not show, row-major.
    std::vector<bool> hole_mask(std::size_t index) const;

    /// Counts over all views of the last render(), the cascade's corner views included.
    HoleCounts hole_counts() const;

    std::uint64_t invalid_sample_count() const; ///< must stay 0

private:
    std::unique_ptr<GridRendererState> state_;
};

} // namespace fieldcast::render
