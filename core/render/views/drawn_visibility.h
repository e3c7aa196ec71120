// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/command_recorder.h"
#include "core/gpu/raster_pipeline.h"
#include "core/render/views/visibility_batch.h"
#include "core/scene/gpu_scene.h"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace fieldcast::render {

/// Visibility of views by a rasteriser: every triangle of a solid surface that may be in a view is drawn, the nearest
/// stays. Agrees with rays but for pixels whose centre is within 1/512 pixel of an edge, and surfaces closer to each
/// other than the depth buffer resolves. What is nearer to a camera than 1/10 000 of the scene's radius is not seen.
class DrawnVisibility {
public:
    DrawnVisibility(const gpu::Device& device, const scene::GpuScene& scene, const scene::DrawGeometry& geometry);

    /// Whether drawing should take less time than rays.
    bool is_fast(const VisibilityBatch& batch) const;

    /// Into the batch's visibility, and its layers if the scene has BLEND surfaces. Visible after a barrier.
    void record(gpu::CommandRecorder& recorder, const VisibilityBatch& batch);

private:
    std::unique_ptr<gpu::RasterPipeline> make_pipeline(scene::AlphaMode mode) const;
    glm::mat4 clip_from_group(const glm::mat4& clip_from_world, const scene::DrawGroup& group) const;
    void resize(const VisibilityBatch& batch);
    void draw_view(gpu::CommandRecorder& recorder, const VisibilityBatch& batch, std::size_t view,
                   std::uint32_t layer) const;
    void name_triangles(gpu::CommandRecorder& recorder, const VisibilityBatch& batch) const;
    void find_layers(gpu::CommandRecorder& recorder, const VisibilityBatch& batch) const;

    const gpu::Device& device_;
    const scene::GpuScene& scene_;
    const scene::DrawGeometry& geometry_;
    float near_m_;
    std::vector<VkFormat> formats_;
    std::vector<std::pair<scene::AlphaMode, std::unique_ptr<gpu::RasterPipeline>>> pipelines_; ///< in drawing order
    gpu::Kernel name_triangles_;
    std::optional<gpu::Kernel> find_layers_;
    gpu::RasterTarget target_;
    gpu::Buffer numbers_; ///< of triangles, u32 per pixel
    gpu::Buffer marks_;   ///< a byte per pixel; only with BLEND surfaces
};

} // namespace fieldcast::render
