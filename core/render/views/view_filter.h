// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/render/denoise/illumination_filter.h"
#include "core/render/source/source_planes.h"
#include "core/render/view_request.h"

#include <span>

namespace fieldcast::render {

/// Averages the light of views over time and, with DenoisedImages::kViews, denoises it, before their materials are
/// applied (docs/lightfield.md). Every view is a page, just as every source is a page in the source's filter. Keeps the
/// history of one set of views; another set starts without history.
class ViewFilter {
public:
    ViewFilter(const gpu::Device& device, const scene::GpuScene& scene);

    /// Whether the settings of this frame average or denoise views.
    static bool is_wanted(const FrameHeader& header);

    static std::uint64_t bytes_per_pixel(const RenderSettings& settings);
    /// Pixels of the last frame's views.
    std::uint32_t texel_count() const { return request_.width_px * request_.height_px * view_count(); }

    /// Most pixels, over all views, that fit on the device.
    static std::uint64_t max_pixels(const gpu::Device& device, const RenderSettings& settings);

    /// Throws UserError if `request` has more than max_pixels().
    static void check(const gpu::Device& device, const RenderSettings& settings, const ViewRequest& request);

    /// Begins a frame. `cameras` are those of the views; `request` must have passed check().
    void begin(const FrameHeader& header, const ViewRequest& request, std::span<const shared::CameraRecord> cameras);

    /// Device addresses for geometry and noisy light of this frame's views; reprojection writes every pixel.
    shared::ViewLight light() const;

    /// Buffers that record() reads and writes besides the light.
    struct Targets {
        const gpu::Buffer& visibility;
        const gpu::Buffer& layers;
        const gpu::Buffer& radiance; ///< output, for pixels that show a surface
    };
    void record(gpu::CommandRecorder& recorder, const FrameHeader& header, const Targets& targets);

    /// Ends the frame, after its submission.
    void end() { filter_.swap(); }

private:
    std::uint32_t view_count() const { return static_cast<std::uint32_t>(request_.positions.size()); }
    FilterFrame make_frame(const FrameHeader& header, const Targets& targets) const;

    const gpu::Device& device_;
    const scene::GpuScene& scene_;
    IlluminationFilter filter_;
    GroupList groups_; ///< every group
    gpu::Kernel shade_;
    ViewRequest request_; ///< of this frame; of the previous one until begin()
    std::uint64_t pose_count_ = 0;
    bool has_history_ = false;
    std::vector<shared::CameraRecord> records_; ///< cameras of the views
    gpu::Buffer cameras_;                       ///< CameraRecords of this frame, then of the previous one
};

} // namespace fieldcast::render
