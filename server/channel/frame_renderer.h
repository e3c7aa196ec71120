// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"
#include "core/image/image_file.h"
#include "core/render/source/source_renderer.h"
#include "core/render/views/grid_renderer.h"
#include "core/render/warp/warp_planes.h"
#include "core/scene/gpu_scene.h"
#include "server/channel/channel_clock.h"
#include "server/channel/settings.h"
#include "server/feed/channel_info.h"
#include "server/feed/encoded_frame.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace fieldcast::channel {

/// Views of one geometry and size, and the formats that clients want.
struct RenderedViews {
    std::vector<wire::ViewFormat> formats; ///< differ in their encoding only
    Views views;
};

/// Whether one rendering serves both formats.
bool is_same_batch(const wire::ViewFormat& a, wire::ViewFormat b);

/// One frame, not yet encoded.
struct RenderedFrame {
    FrameHeader header;
    wire::ServerTimes times;
    std::optional<SourceFrame> source; ///< the planes named in `choices`
    std::vector<wire::PlaneChoice> choices;
    std::vector<RenderedViews> views;
    std::uint64_t asked_views = 0; ///< as in feed::Demand
    bool needs_alone = false;      ///< as in feed::Demand
    bool needs_key = false;        ///< as in feed::Demand
    std::chrono::steady_clock::time_point begun{}; ///< as in feed::Demand
};

/// Values that a channel settles when it starts. They suffice for another renderer of the scene on the same device.
struct SettledChannel {
    std::shared_ptr<const scene::Scene> scene;
    const scene::CameraNode* camera_node = nullptr; ///< in `scene`
    scene::Traversal traversal = scene::Traversal::kBvh;
    scene::VisibilityMethod visibility = scene::VisibilityMethod::kRays;
    std::optional<Camera> fixed_camera; ///< set if the camera does not follow its node
    RenderSettings settings;            ///< including the exposure
    feed::ChannelInfo info;
};

/// A scene on the device with both renderers, for one channel. Not thread-safe; may be used by one thread after
/// another.
class FrameRenderer {
public:
    /// Loads the scene, settles guard band and exposure, renders once so that every kernel is compiled.
    /// Throws UserError if the scene is not usable.
    FrameRenderer(const gpu::Device& device, const Settings& settings, const ChannelChoice& channel);

    /// Shares the loaded scene, but nothing on the device. `settled` may come from a renderer that no longer
    /// exists.
    FrameRenderer(const gpu::Device& device, const Settings& settings, const SettledChannel& settled);

    SettledChannel settled() const;
    const feed::ChannelInfo& info() const { return info_; }
    const scene::Scene& scene() const { return *scene_; }

    /// Leaves views out for which the device has no memory, and logs that.
    RenderedFrame render(std::uint64_t frame_id, const FrameMoment& moment, const feed::Demand& demand);

    /// Frees the memory of views whose geometry or size is not in `kept`.
    void forget_views(const feed::Demand& kept);

    /// Linear radiance of one view, path traced with `samples` per pixel, without reuse and limits. `progress` gets
    /// the number of samples so far; if it returns true, the result is empty.
    std::optional<image::RgbF32> path_trace(const FrameMoment& moment, LatticePosition position, std::uint32_t samples,
                                            const std::function<bool(std::uint32_t)>& progress);

    float exposure() const { return render_settings_.exposure; }
    std::uint64_t invalid_sample_count() const; ///< must stay 0

private:
    void load(const ChannelChoice& channel);
    void make_renderers(scene::Traversal traversal, scene::VisibilityMethod visibility);
    void settle_lattice(const ChannelChoice& choice);
    void limit_views();
    void settle_guard_band();
    void check_planes(const Camera& source) const;
    void warm_up();

    FrameHeader pose(std::uint64_t frame_id, const FrameMoment& moment);
    SourceFrame make_planes(const render::SourcePlanes& source, const std::vector<wire::PlaneChoice>& choices);
    bool has_memory_for(const render::ViewRequest& request) const;
    std::vector<RenderedViews> render_views(const render::SourcePlanes& source, const feed::Demand& demand);

    const gpu::Device& device_;
    const Settings& settings_;
    std::shared_ptr<const scene::Scene> scene_; ///< at a fixed address: the renderers refer to it
    const scene::CameraNode* camera_node_ = nullptr;
    std::unique_ptr<scene::GpuScene> gpu_scene_;
    std::unique_ptr<render::SourceRenderer> source_renderer_;
    std::unique_ptr<render::GridRenderer> grid_renderer_;
    std::unique_ptr<render::WarpPlanesRenderer> warp_planes_; ///< null until a client wants such planes
    std::optional<Camera> fixed_camera_;
    RenderSettings render_settings_;
    feed::ChannelInfo info_;
};

} // namespace fieldcast::channel
