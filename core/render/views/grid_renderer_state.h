// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/command_recorder.h"
#include "core/gpu/readback.h"
#include "core/lightfield/views.h"
#include "core/render/frame_parameters.h"
#include "core/render/source/source_planes.h"
#include "core/render/view_request.h"
#include "core/render/views/hole_filler.h"
#include "core/render/views/reflections.h"
#include "core/render/views/view_history.h"
#include "core/render/views/view_visibility.h"

namespace fieldcast::render {

/// Kernels, buffers and history of a GridRenderer; for its own files.
struct GridRendererState {
    GridRendererState(const gpu::Device& d, const scene::GpuScene& s);

    void resize(const SourcePlanes& source);
    /// Sets `view_cameras`.
    void place_views(const Camera& source);
    /// Records the writes of `cameras` and `views`; a barrier must follow.
    void record_cameras(const SourcePlanes& source, const std::vector<std::uint32_t>& corners);
    void record_visibility();
    void record_interleave(const SourcePlanes& source);
    void record_reproject(const FrameHeader& header);
    /// Filtered views get no reflections: filters over views cannot use rays that were traced for one view.
    bool wants_reflections(const FrameHeader& header) const {
        return filter == nullptr && reflections.are_wanted(header);
    }
    shared::TraceListParams list_params(const FrameHeader& header) const;
    void record_holes(FrameHeader& header);
    void record_layers(const FrameHeader& header);
    HoleFiller::Batch make_batch(const FrameHeader& header, const ViewRequest& asked);
    void begin_filter(const FrameHeader& header);
    void record_tone_map(const FrameHeader& header);
    /// Pixels and counters of a batch on the host.
    struct Downloaded {
        Views views; ///< `wanted` of them, still without header and discards
        std::vector<std::uint32_t> counters;
    };
    /// Records the copies to the host; `result` is filled by readback.finish() and must not be changed before.
    void record_download(Downloaded& result);
    DiscardCounts discards(const std::vector<std::uint32_t>& values, std::size_t view) const;
    std::vector<glm::uvec2> download_visibility(std::size_t view) const;
    std::size_t counter_count() const { return shared::kCounterDiscards + 4ULL * view_count(); }
    std::uint32_t view_count() const { return static_cast<std::uint32_t>(request.positions.size()); }

    const gpu::Device& device;
    const scene::GpuScene& scene;
    gpu::CommandRecorder recorder;
    gpu::BindingLayout source_layout;
    ViewVisibility view_visibility;
    gpu::Kernel interleave_kernel;
    gpu::Kernel reproject_kernel;
    gpu::Kernel finish_kernel;
    gpu::Kernel layers_kernel;
    gpu::Kernel tone_map_kernel;

    HoleFiller filler;
    Reflections reflections;

    gpu::Readback readback;

    ViewRequest request;    ///< the request and the corner views of the hole cascade
    std::size_t wanted = 0; ///< number of requested views; they come first
    ViewHistories histories;
    ViewFilter* filter = nullptr; ///< of the views of this frame; null: they are not filtered
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

    gpu::Buffer cameras; ///< of the sources (kMaxSources records), then of the views
    gpu::Buffer views;   ///< ViewRecord
    gpu::Buffer counters;
    gpu::Buffer visibility;
    gpu::Buffer layers;
    gpu::Buffer radiance;
    gpu::Buffer layer_pixels;
    gpu::Buffer rgb8;
};

} // namespace fieldcast::render
