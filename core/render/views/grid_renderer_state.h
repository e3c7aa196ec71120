// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/recorder.h"
#include "core/render/frame_parameters.h"
#include "core/render/views/grid_renderer.h"
#include "core/render/views/hole_filler.h"
#include "core/render/views/reflections.h"
#include "core/render/views/view_history.h"
#include "core/render/views/view_visibility.h"

namespace fieldcast::render {

/// What a GridRenderer has, for its own files.
struct GridRenderer::State {
    State(const gpu::Device& d, const scene::GpuScene& s);

    void resize(const SourcePlanes& source);
    void upload_cameras(const SourcePlanes& source, const std::vector<std::uint32_t>& corners);
    void record_visibility();
    void record_interleave(const SourcePlanes& source);
    void record_reproject(const FrameHeader& header);
    /// Filters over views know nothing of rays that were looked up for one view.
    bool wants_reflections(const FrameHeader& header) const {
        return filter == nullptr && reflections.are_wanted(header);
    }
    shared::TraceListParams list_params(const FrameHeader& header) const;
    void record_holes(FrameHeader& header);
    void record_layers(const FrameHeader& header);
    HoleFiller::Batch make_batch(const FrameHeader& header, const ViewRequest& asked);
    void begin_filter(const FrameHeader& header);
    void record_tone_map(const FrameHeader& header);
    Views download(const FrameHeader& header, const std::vector<std::uint32_t>& counts) const;
    DiscardCounts discards(const std::vector<std::uint32_t>& values, std::size_t view) const;
    std::vector<glm::uvec2> download_visibility(std::size_t view) const;
    std::uint32_t view_count() const { return static_cast<std::uint32_t>(request.positions.size()); }

    const gpu::Device& device;
    const scene::GpuScene& scene;
    gpu::Recorder recorder;
    gpu::BindingLayout source_layout;
    ViewVisibility view_visibility;
    gpu::Kernel interleave_kernel;
    gpu::Kernel reproject_kernel;
    gpu::Kernel finish_kernel;
    gpu::Kernel layers_kernel;
    gpu::Kernel tone_map_kernel;

    HoleFiller filler;
    Reflections reflections;

    ViewRequest request;    ///< with the corner views of the hole cascade
    std::size_t wanted = 0; ///< views that were asked for; they come first
    ViewHistories histories;
    ViewFilter* filter = nullptr; ///< of this frame's views; null: they are not filtered
    HoleCounts hole_counts;
    std::vector<Camera> view_cameras;
    std::uint32_t source_texels = 0; ///< of all pages
    std::uint64_t view_pixels = 0; ///< over all views, padded
    std::uint64_t invalid_samples = 0;

    gpu::Buffer geometry; ///< of the source, interleaved
    gpu::Buffer illumination;
    gpu::TexelView geometry_view;
    gpu::TexelView illumination_view;
    gpu::BindingSet source_set;

    gpu::Buffer cameras; ///< kMaxSources of sources, then of the views
    gpu::Buffer views;   ///< ViewRecord
    gpu::Buffer counters;
    gpu::Buffer visibility;
    gpu::Buffer layers;
    gpu::Buffer radiance;
    gpu::Buffer layer_pixels;
    gpu::Buffer rgb8;
};

} // namespace fieldcast::render
