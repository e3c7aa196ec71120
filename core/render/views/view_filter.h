// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/render/denoise/illumination_filter.h"
#include "core/render/source/source_planes.h"
#include "core/render/view_request.h"

#include <span>

namespace fieldcast::render {

/// Averages over time and, with DenoisedImages::kViews, denoises the light of views before their own materials come in
/// (docs/lightfield.md). Every view is a page, as every source is one of the source's filter. Keeps the history of one
/// set of views; another set starts anew.
class ViewFilter {
public:
    ViewFilter(const gpu::Device& device, const scene::GpuScene& scene);

    /// Whether the settings ask for it in this frame.
    static bool is_wanted(const FrameHeader& header);

    static std::uint64_t bytes_per_pixel(const RenderSettings& settings);
    std::uint32_t texel_count() const { return request_.width_px * request_.height_px * view_count(); } ///< last frame's

    /// How many pixels, over all views, the device has room for.
    static std::uint64_t max_pixels(const gpu::Device& device, const RenderSettings& settings);

    /// Throws UserError if `request` is more.
    static void check(const gpu::Device& device, const RenderSettings& settings, const ViewRequest& request);

    /// A frame begins. `cameras`: of the views, which passed check().
    void begin(const FrameHeader& header, const ViewRequest& request, std::span<const shared::CameraRecord> cameras);

    /// Where geometry and noisy light of this frame's views are to be written; reprojection fills all of it.
    shared::ViewLight light() const;

    /// What is read and written besides the light.
    struct Targets {
        const gpu::Buffer& visibility;
        const gpu::Buffer& layers;
        const gpu::Buffer& radiance; ///< of pixels that see a surface
    };
    void record(gpu::Recorder& recorder, const FrameHeader& header, const Targets& targets);

    /// The frame was submitted.
    void end() { filter_.swap(); }

private:
    std::uint32_t view_count() const { return static_cast<std::uint32_t>(request_.positions.size()); }
    FilterFrame make_frame(const FrameHeader& header, const Targets& targets) const;

    const gpu::Device& device_;
    const scene::GpuScene& scene_;
    IlluminationFilter filter_;
    GroupList groups_; ///< all
    gpu::Kernel shade_;
    ViewRequest request_; ///< of this frame, later of the one before
    std::uint64_t pose_count_ = 0;
    bool has_history_ = false;
    std::vector<shared::CameraRecord> records_; ///< of the views
    gpu::Buffer cameras_;                       ///< now, then as they were
};

} // namespace fieldcast::render
