// SPDX-License-Identifier: Apache-2.0
#include "server/channel/frame_renderer.h"

#include "core/base/log.h"
#include "core/gpu/free_memory.h"
#include "core/render/reference_renderer.h"
#include "core/render/setup.h"

#include <algorithm>

namespace fieldcast::channel {

namespace {

std::int64_t steady_ns() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

/// The semantics in `choices` that the source renderer makes.
std::vector<PlaneSemantic> source_semantics_of(const std::vector<wire::PlaneChoice>& choices) {
    std::vector<PlaneSemantic> semantics;
    for (const wire::PlaneChoice& choice : choices) {
        const bool is_source =
            std::ranges::find(render::kSourceSemantics, choice.semantic) != render::kSourceSemantics.end();
        if (is_source && std::ranges::find(semantics, choice.semantic) == semantics.end()) {
            semantics.push_back(choice.semantic);
        }
    }
    return semantics;
}

/// Views to render in one batch, and the formats that they are wanted in.
struct Batch {
    std::vector<wire::ViewFormat> formats;
    render::ViewRequest request;
};

std::vector<Batch> batches_of(const feed::Demand& demand) {
    std::vector<Batch> batches;
    for (const feed::ViewDemand& set : demand.views) {
        const wire::ViewFormat& format = set.format;
        auto batch =
            std::ranges::find_if(batches, [&](const Batch& b) { return is_same_batch(b.formats.front(), format); });
        if (batch == batches.end()) {
            batch = batches.insert(batch, Batch{.formats = {},
                                                .request = {.geometry = format.geometry,
                                                            .fovy_rad = format.fovy_rad,
                                                            .width_px = format.width_px,
                                                            .height_px = format.height_px,
                                                            .positions = {}}});
        }
        batch->formats.push_back(format);
        auto& positions = batch->request.positions;
        positions.insert(positions.end(), set.positions.begin(), set.positions.end());
        std::ranges::sort(positions);
        const auto repeated = std::ranges::unique(positions);
        positions.erase(repeated.begin(), repeated.end());
    }
    return batches;
}

} // namespace

FrameRenderer::FrameRenderer(const gpu::Device& device, const Settings& settings, const ChannelChoice& channel)
    : device_(device), settings_(settings), render_settings_(settings.render) {
    info_.name = channel.name;
    load(channel);
    settle_lattice(channel);
    limit_views();
    settle_guard_band();
    warm_up();
}

FrameRenderer::FrameRenderer(const gpu::Device& device, const Settings& settings, const SettledChannel& settled)
    : device_(device), settings_(settings), scene_(settled.scene), camera_node_(settled.camera_node),
      fixed_camera_(settled.fixed_camera), render_settings_(settled.settings), info_(settled.info) {
    make_renderers(settled.traversal, settled.visibility);
}

SettledChannel FrameRenderer::settled() const {
    return {.scene = scene_,
            .camera_node = camera_node_,
            .traversal = gpu_scene_->traversal(),
            .visibility = gpu_scene_->visibility(),
            .fixed_camera = fixed_camera_,
            .settings = render_settings_,
            .info = info_};
}

void FrameRenderer::make_renderers(scene::Traversal traversal, scene::VisibilityMethod visibility) {
    gpu_scene_ = std::make_unique<scene::GpuScene>(device_, *scene_, traversal, visibility);
    source_renderer_ = std::make_unique<render::SourceRenderer>(device_, *gpu_scene_);
    grid_renderer_ = std::make_unique<render::GridRenderer>(device_, *gpu_scene_);
}

bool is_same_batch(const wire::ViewFormat& a, wire::ViewFormat b) {
    b.encoding = a.encoding;
    return a == b;
}

FrameHeader FrameRenderer::pose(std::uint64_t frame_id, const FrameMoment& moment) {
    gpu_scene_->pose(moment.scene_time_ns, moment.cut);
    FrameHeader header;
    header.frame_id = frame_id;
    header.scene_time_ns = moment.scene_time_ns;
    header.cut = moment.cut;
    header.seed = settings_.seed;
    header.noise_frame = moment.noise_frame;
    header.source = fixed_camera_
                        ? *fixed_camera_
                        : render::source_camera(*gpu_scene_, *camera_node_, settings_.width_px, settings_.height_px);
    if (moment.pose) {
        header.applied_pose = AppliedPose{moment.pose->lease, moment.pose->sequence, moment.pose->client_time_ns};
        header.source.world_from_camera = moment.pose->world_from_camera;
    }
    header.guard_band = info_.guard_band;
    header.source_positions = settings_.source_positions;
    header.source_geometry = info_.largest_grid.geometry;
    header.settings = render_settings_;
    return header;
}

RenderedFrame FrameRenderer::render(std::uint64_t frame_id, const FrameMoment& moment, const feed::Demand& demand) {
    RenderedFrame frame;
    frame.asked_views = demand.asked_views;
    frame.needs_alone = demand.needs_alone;
    frame.needs_key = demand.needs_key;
    frame.begun = demand.begun;
    frame.times.pose_sampled_ns = steady_ns();
    const FrameHeader header = pose(frame_id, moment);
    frame.times.render_begin_ns = steady_ns();
    const render::SourcePlanes& source = source_renderer_->render(header);
    frame.header = source.header();
    if (!demand.planes.empty()) {
        frame.choices = demand.planes;
        frame.source = make_planes(source, demand.planes);
    }
    frame.views = render_views(source, demand);
    frame.times.render_end_ns = steady_ns();
    return frame;
}

SourceFrame FrameRenderer::make_planes(const render::SourcePlanes& source,
                                       const std::vector<wire::PlaneChoice>& choices) {
    const auto is_wanted = [&](PlaneSemantic semantic) {
        return std::ranges::find(choices, semantic, &wire::PlaneChoice::semantic) != choices.end();
    };
    SourceFrame frame = source.download(source_semantics_of(choices));
    if (is_wanted(PlaneSemantic::kTotalLight)) {
        frame.planes.push_back(source_renderer_->total_light());
    }
    if (is_wanted(PlaneSemantic::kColour) || is_wanted(PlaneSemantic::kInverseDepth)) {
        if (warp_planes_ == nullptr) {
            warp_planes_ = std::make_unique<render::WarpPlanesRenderer>(device_, *gpu_scene_, *grid_renderer_);
        }
        const bool has_residual =
            is_wanted(PlaneSemantic::kResidualColour) || is_wanted(PlaneSemantic::kResidualInverseDepth);
        warp_planes_->render(source, info_.largest_grid, has_residual, frame);
    }
    return frame;
}

std::vector<RenderedViews> FrameRenderer::render_views(const render::SourcePlanes& source, const feed::Demand& demand) {
    std::vector<RenderedViews> rendered;
    for (Batch& batch : batches_of(demand)) {
        if (has_memory_for(batch.request)) {
            rendered.push_back(
                {.formats = std::move(batch.formats), .views = grid_renderer_->render(source, batch.request)});
        }
    }
    return rendered;
}

// Admission counts the memory for clients' views, but other programs may have taken device memory since.
bool FrameRenderer::has_memory_for(const render::ViewRequest& request) const {
    const std::uint64_t missing = grid_renderer_->missing_bytes(render_settings_, request);
    const std::uint64_t free = missing > 0 ? gpu::free_memory_bytes(device_) : 0;
    if (missing > free) {
        log::warn("no memory for views", {{"channel", info_.name},
                                          {"views", request.positions.size()},
                                          {"missing_bytes", missing},
                                          {"free_bytes", free}});
    }
    return missing <= free;
}

void FrameRenderer::forget_views(const feed::Demand& kept) {
    std::vector<render::ViewRequest> requests;
    for (Batch& batch : batches_of(kept)) {
        requests.push_back(std::move(batch.request));
    }
    grid_renderer_->forget_all_but(requests);
}

std::optional<image::RgbF32> FrameRenderer::path_trace(const FrameMoment& moment, LatticePosition position,
                                                       std::uint32_t samples,
                                                       const std::function<bool(std::uint32_t)>& progress) {
    constexpr std::uint32_t kBatch = 4; // samples between two calls of `progress`
    const FrameHeader header = pose(1, moment);
    RenderSettings settings = header.settings;
    settings.indirect_clamp = 0.0F;
    render::ReferenceRenderer renderer(device_, *gpu_scene_);
    renderer.start(view_camera(header.source, info_.largest_grid.geometry, position, info_.fovy_rad, settings_.width_px,
                               settings_.height_px));
    while (renderer.samples_per_pixel() < samples) {
        if (progress(renderer.samples_per_pixel())) {
            return std::nullopt;
        }
        settings.samples_per_pixel = std::min(kBatch, samples - renderer.samples_per_pixel());
        renderer.accumulate(settings, settings_.seed);
    }
    return image::RgbF32{settings_.width_px, settings_.height_px, renderer.image()};
}

std::uint64_t FrameRenderer::invalid_sample_count() const {
    return source_renderer_->invalid_sample_count() + grid_renderer_->invalid_sample_count();
}

} // namespace fieldcast::channel
