// SPDX-License-Identifier: Apache-2.0
// The steps of FrameRenderer's first constructor, which settle what stays the same while a channel runs.
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

void FrameRenderer::load(const ChannelChoice& channel) {
    scene::LoadOptions options;
    options.environment = settings_.environment;
    options.sky = settings_.sky.value_or(options.sky);
    options.surroundings = settings_.surroundings;
    scene::Scene scene = scene::load_scene(channel.scene, options);
    for (const std::string& warning : scene.warnings) {
        log::warn("scene", {{"channel", info_.name}, {"warning", warning}});
    }
    if (scene.has_studio) {
        log::info("lit by the studio", {{"channel", info_.name}, {"change", "--environment sky, none or FILE"}});
    }
    options.surroundings = scene.has_studio ? scene::Surroundings::kStudio : scene::Surroundings::kSky;
    const Viewpoint viewpoint = settle_viewpoint(scene, settings_, info_.name);
    scene_ = std::make_shared<const scene::Scene>(std::move(scene));
    camera_node_ = &scene_->cameras[viewpoint.camera];
    info_.largest_grid = settings_.largest_grid;
    info_.largest_grid.geometry = {.spacing_m = glm::vec2(viewpoint.spacing_m),
                                   .convergence_m = viewpoint.convergence_m};
    info_.scene_hash = scene_->hash;
    info_.bundle = std::make_shared<const std::vector<std::byte>>(scene::make_bundle(channel.scene, options));
    make_renderers(scene::choose_traversal(device_, settings_.traversal),
                   scene::choose_visibility(device_, settings_.visibility));
}

void FrameRenderer::settle_lattice(const ChannelChoice& choice) {
    const bool is_node_animated = scene_->nodes[camera_node_->node].is_animated;
    info_.source_width_px = settings_.width_px;
    info_.source_height_px = settings_.height_px;
    info_.source_count = static_cast<std::uint32_t>(settings_.source_positions.size());
    info_.fovy_rad = camera_node_->fovy_rad;
    info_.frames_per_second = settings_.frames_per_second;
    info_.camera = camera_node_->name;
    const bool is_scripted = is_node_animated && !settings_.has_fixed_camera && !settings_.fixed_time_s;
    info_.control = is_scripted ? feed::CameraControl::kScripted : feed::CameraControl::kFixed;
    info_.control = choice.control.value_or(info_.control);
    info_.steering_lease = settings_.steering_lease;
    info_.max_view_pixels = settings_.max_channel_pixels;
    info_.lossy_quality = static_cast<std::uint8_t>(settings_.lossy_quality);
}

// Views that average or denoise their own light need device memory.
void FrameRenderer::limit_views() {
    info_.bytes_per_view_pixel = render::GridRenderer::bytes_per_pixel(render_settings_);
    if (render_settings_.denoised_images == DenoisedImages::kSource && !render_settings_.accumulate_views) {
        return;
    }
    render::ViewFilter::check(device_, render_settings_,
                              {.geometry = info_.largest_grid.geometry,
                               .fovy_rad = info_.fovy_rad,
                               .width_px = settings_.width_px,
                               .height_px = settings_.height_px,
                               .positions = lattice_positions(info_.largest_grid)});
    const bool is_own = info_.control == feed::CameraControl::kOwn;
    const std::uint64_t most = render::ViewFilter::max_pixels(device_, render_settings_);
    info_.max_view_pixels = std::min(info_.max_view_pixels, is_own ? most / settings_.own_cameras.max_cameras : most);
}

void FrameRenderer::settle_guard_band() {
    const auto start_ns = static_cast<std::int64_t>(settings_.fixed_time_s.value_or(0.0) * 1e9);
    gpu_scene_->pose(start_ns, true);
    const Camera source = render::source_camera(*gpu_scene_, *camera_node_, settings_.width_px, settings_.height_px);
    if (settings_.has_fixed_camera || is_moved_by_clients(info_.control)) {
        fixed_camera_ = source;
    }
    info_.guard_band = settings_.guard_band;
    check_planes(source);
    if (settings_.guard_band_mode == GuardBandMode::kFixed) {
        return;
    }
    const GuardBandChoice choice =
        render::measure_guard_band(device_, *gpu_scene_, source, info_.largest_grid, settings_.source_positions);
    info_.guard_band = choice.band;
    log::info("guard band settled", {{"channel", info_.name},
                                     {"left_px", choice.band.left_px},
                                     {"right_px", choice.band.right_px},
                                     {"top_px", choice.band.top_px},
                                     {"bottom_px", choice.band.bottom_px},
                                     {"removed_percent", choice.removed_share * 100.0},
                                     {"extra_percent", choice.extra_share * 100.0}});
}

// Throws if planes would be taller than receivers accept.
void FrameRenderer::check_planes(const Camera& source) const {
    FrameHeader header;
    header.source = source;
    header.guard_band = info_.guard_band;
    header.source_positions = settings_.source_positions;
    header.layer_count = gpu_scene_->has_blend() ? kMaxLayers : 0;
    const std::uint32_t height = plane_height(header, PlaneSemantic::kDiffuse);
    if (height > kMaxPlaneSide * 8 / 9) { // an automatic guard band adds an eighth at most
        throw UserError("channel " + info_.name + ": " + std::to_string(header.source_positions.size()) +
                        " sources of this --size are " + std::to_string(height) +
                        " rows of pixels; take fewer --sources or a smaller --size");
    }
}

void FrameRenderer::warm_up() {
    const auto start_ns = static_cast<std::int64_t>(settings_.fixed_time_s.value_or(0.0) * 1e9);
    const FrameHeader header = pose(0, {.scene_time_ns = start_ns, .cut = true});
    const render::SourcePlanes& source = source_renderer_->render(header);
    if (settings_.has_auto_exposure) {
        render_settings_.exposure = render::auto_exposure(*grid_renderer_, source);
    }
    ViewGrid grid = info_.largest_grid;
    grid.rows = grid.cols = 2;
    grid_renderer_->render(source, {.geometry = grid.geometry,
                                    .fovy_rad = info_.fovy_rad,
                                    .width_px = settings_.width_px,
                                    .height_px = settings_.height_px,
                                    .positions = lattice_positions(grid)});
    log::info(
        "exposure settled",
        {{"channel", info_.name}, {"exposure", render_settings_.exposure}, {"is_auto", settings_.has_auto_exposure}});
}

} // namespace fieldcast::channel
