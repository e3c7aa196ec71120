// SPDX-License-Identifier: Apache-2.0
// What a FrameRenderer settles once, when its channel starts.
#include "core/base/error.h"
#include "core/base/log.h"
#include "core/render/setup.h"
#include "core/render/views/view_filter.h"
#include "core/scene/bundle.h"
#include "core/scene/gltf/loader.h"
#include "server/channel/frame_renderer.h"
#include "server/channel/viewpoint.h"

#include <algorithm>

namespace fieldcast::channel {

FrameRenderer::FrameRenderer(const gpu::Device& device, const ops::Config& config, const ops::ChannelChoice& channel)
    : device_(device), config_(config), settings_(config.settings) {
    info_.name = channel.name;
    load(channel);
    settle_lattice(channel);
    limit_views();
    settle_guard_band();
    warm_up();
}

FrameRenderer::FrameRenderer(const gpu::Device& device, const ops::Config& config, const SettledChannel& settled)
    : device_(device), config_(config), scene_(settled.scene), camera_node_(settled.camera_node),
      fixed_camera_(settled.fixed_camera), settings_(settled.settings), info_(settled.info) {
    make_renderers(settled.traversal, settled.visibility);
}

SettledChannel FrameRenderer::settled() const {
    return {.scene = scene_,
            .camera_node = camera_node_,
            .traversal = gpu_scene_->traversal(),
            .visibility = gpu_scene_->visibility(),
            .fixed_camera = fixed_camera_,
            .settings = settings_,
            .info = info_};
}

void FrameRenderer::load(const ops::ChannelChoice& channel) {
    scene::LoadOptions options;
    options.environment = config_.environment;
    options.sky = config_.sky.value_or(options.sky);
    options.surroundings = config_.surroundings;
    scene::Scene scene = scene::load_scene(channel.scene, options);
    for (const std::string& warning : scene.warnings) {
        log::warn("scene", {{"channel", info_.name}, {"warning", warning}});
    }
    if (scene.has_studio) {
        log::info("lit by the studio", {{"channel", info_.name}, {"change", "--environment sky, none or FILE"}});
    }
    options.surroundings = scene.has_studio ? scene::Surroundings::kStudio : scene::Surroundings::kSky;
    const Viewpoint viewpoint = settle_viewpoint(scene, config_, info_.name);
    scene_ = std::make_shared<const scene::Scene>(std::move(scene));
    camera_node_ = &scene_->cameras[viewpoint.camera];
    info_.largest_grid = config_.largest_grid;
    info_.largest_grid.geometry = {.spacing_m = glm::vec2(viewpoint.spacing_m),
                                   .convergence_m = viewpoint.convergence_m};
    info_.scene_hash = scene_->hash;
    info_.bundle = std::make_shared<const std::vector<std::byte>>(scene::make_bundle(channel.scene, options));
    make_renderers(scene::choose_traversal(device_, config_.traversal),
                   scene::choose_visibility(device_, config_.visibility));
}

void FrameRenderer::make_renderers(scene::Traversal traversal, scene::VisibilityMethod visibility) {
    gpu_scene_ = std::make_unique<scene::GpuScene>(device_, *scene_, traversal, visibility);
    source_renderer_ = std::make_unique<render::SourceRenderer>(device_, *gpu_scene_);
    grid_renderer_ = std::make_unique<render::GridRenderer>(device_, *gpu_scene_);
}

void FrameRenderer::settle_lattice(const ops::ChannelChoice& choice) {
    const bool is_node_animated = scene_->nodes[camera_node_->node].is_animated;
    info_.source_width_px = config_.width_px;
    info_.source_height_px = config_.height_px;
    info_.source_count = static_cast<std::uint32_t>(config_.source_positions.size());
    info_.fovy_rad = camera_node_->fovy_rad;
    info_.frames_per_second = config_.frames_per_second;
    info_.camera = camera_node_->name;
    const bool is_scripted = is_node_animated && !config_.has_fixed_camera && !config_.fixed_time_s;
    info_.control = is_scripted ? feed::CameraControl::kScripted : feed::CameraControl::kFixed;
    info_.control = choice.control.value_or(info_.control);
    info_.steering_lease = config_.steering_lease;
    info_.max_view_pixels = config_.max_channel_pixels;
    info_.lossy_quality = static_cast<std::uint8_t>(config_.lossy_quality);
}

// Views that average or denoise their own light need room on the device.
void FrameRenderer::limit_views() {
    info_.bytes_per_view_pixel = render::GridRenderer::bytes_per_pixel(settings_);
    if (settings_.denoised_images == DenoisedImages::kSource && !settings_.accumulate_views) {
        return;
    }
    render::ViewFilter::check(device_, settings_,
                              {.geometry = info_.largest_grid.geometry,
                               .fovy_rad = info_.fovy_rad,
                               .width_px = config_.width_px,
                               .height_px = config_.height_px,
                               .positions = lattice_positions(info_.largest_grid)});
    const bool is_own = info_.control == feed::CameraControl::kOwn;
    const std::uint64_t most = render::ViewFilter::max_pixels(device_, settings_);
    info_.max_view_pixels = std::min(info_.max_view_pixels, is_own ? most / config_.limits.max_own_cameras : most);
}

void FrameRenderer::settle_guard_band() {
    const auto start_ns = static_cast<std::int64_t>(config_.fixed_time_s.value_or(0.0) * 1e9);
    gpu_scene_->pose(start_ns, true);
    const Camera source = render::source_camera(*gpu_scene_, *camera_node_, config_.width_px, config_.height_px);
    if (config_.has_fixed_camera || is_moved_by_clients(info_.control)) {
        fixed_camera_ = source;
    }
    info_.guard_band = config_.guard_band;
    check_planes(source);
    if (config_.guard_band_mode == ops::GuardBandMode::kFixed) {
        return;
    }
    const GuardBandChoice choice = render::measure_guard_band(device_, *gpu_scene_, source, info_.largest_grid,
                                                                  config_.source_positions);
    info_.guard_band = choice.band;
    log::info("guard band settled", {{"channel", info_.name},
                                     {"left_px", choice.band.left_px},
                                     {"right_px", choice.band.right_px},
                                     {"top_px", choice.band.top_px},
                                     {"bottom_px", choice.band.bottom_px},
                                     {"removed_percent", choice.removed_share * 100.0},
                                     {"extra_percent", choice.extra_share * 100.0}});
}

// A receiver refuses taller planes.
void FrameRenderer::check_planes(const Camera& source) const {
    FrameHeader header;
    header.source = source;
    header.guard_band = info_.guard_band;
    header.source_positions = config_.source_positions;
    header.layer_count = gpu_scene_->has_blend() ? kMaxLayers : 0;
    const std::uint32_t height = plane_height(header, PlaneSemantic::kDiffuse);
    if (height > kMaxPlaneSide * 8 / 9) { // an automatic guard band adds an eighth at most
        throw UserError("channel " + info_.name + ": " + std::to_string(header.source_positions.size()) +
                        " sources of this --size are " + std::to_string(height) +
                        " rows of pixels; take fewer --sources or a smaller --size");
    }
}

void FrameRenderer::warm_up() {
    const auto start_ns = static_cast<std::int64_t>(config_.fixed_time_s.value_or(0.0) * 1e9);
    const FrameHeader header = pose(0, {.scene_time_ns = start_ns, .cut = true});
    const render::SourcePlanes& source = source_renderer_->render(header);
    if (config_.has_auto_exposure) {
        settings_.exposure = render::auto_exposure(*grid_renderer_, source);
    }
    ViewGrid grid = info_.largest_grid;
    grid.rows = grid.cols = 2;
    grid_renderer_->render(source, {.geometry = grid.geometry,
                                    .fovy_rad = info_.fovy_rad,
                                    .width_px = config_.width_px,
                                    .height_px = config_.height_px,
                                    .positions = lattice_positions(grid)});
    log::info("exposure settled",
              {{"channel", info_.name}, {"exposure", settings_.exposure}, {"is_auto", config_.has_auto_exposure}});
}

} // namespace fieldcast::channel
