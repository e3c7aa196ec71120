// SPDX-License-Identifier: Apache-2.0
#include "bench/light_field_run.h"

#include "core/base/error.h"

namespace fieldcast::bench {

namespace {

constexpr std::int64_t kFramesPerSecond = 30;

scene::Scene load(const LightFieldScene::Options& options) {
    scene::LoadOptions load;
    if (!options.environment.empty()) {
        load.environment = options.environment;
    }
    return scene::load_scene(options.file, load);
}

} // namespace

LightFieldScene::LightFieldScene(const gpu::Device& device, const Options& options)
    : size_(options.size), scene_(load(options)), camera_(find_camera(scene_)),
      gpu_scene_(device, scene_, scene::choose_traversal(device, options.traversal),
                 scene::choose_visibility(device, options.visibility)) {
    if (camera_ == nullptr) {
        throw UserError(options.file.string() + ": has no camera");
    }
    const std::optional<ViewGrid> parsed = parse_grid(options.grid);
    if (!parsed) {
        throw UserError("--grid " + options.grid + ": expected ROWSxCOLUMNS");
    }
    grid_ = *parsed;
    const float default_m = camera_->spacing_m.value_or(0.03F);
    grid_.geometry.spacing_m = glm::vec2(options.spacing_m > 0.0 ? static_cast<float>(options.spacing_m) : default_m);
    if (const auto problem = grid_problem(grid_)) {
        throw UserError("--grid: " + *problem);
    }
    pose(0);
}

void LightFieldScene::pose(std::uint32_t frame) {
    gpu_scene_.pose(time_of_frame_ns(frame), frame == 0);
}

std::int64_t LightFieldScene::time_of_frame_ns(std::uint32_t frame) {
    return static_cast<std::int64_t>(frame) * 1'000'000'000 / kFramesPerSecond;
}

void LightFieldScene::choose_grid(std::uint32_t rows, std::uint32_t cols) {
    grid_.rows = rows;
    grid_.cols = cols;
}

Camera LightFieldScene::source() const {
    return render::source_camera(gpu_scene_, *camera_, size_.width_px, size_.height_px);
}

Camera LightFieldScene::view(LatticePosition position) const {
    const Camera from = source();
    return view_camera(from, grid_.geometry, position, vertical_fov(from), size_.width_px, size_.height_px);
}

render::ViewRequest LightFieldScene::request(std::vector<LatticePosition> positions) const {
    return {grid_.geometry, vertical_fov(source()), size_.width_px, size_.height_px, std::move(positions)};
}

LightFieldRun::LightFieldRun(const gpu::Device& device, LightFieldScene& scene, const RenderSettings& settings,
                             bool has_guard_band, std::vector<LatticePosition> source_positions)
    : scene_(scene), source_renderer_(device, scene.gpu_scene()), grid_renderer_(device, scene.gpu_scene()) {
    scene_.pose(0);
    header_.cut = true;
    header_.settings = settings;
    header_.source = scene_.source();
    header_.source_positions = std::move(source_positions);
    header_.source_geometry = scene_.grid().geometry;
    if (has_guard_band) {
        guard_band_ = render::measure_guard_band(device, scene_.gpu_scene(), header_.source, scene_.grid(),
                                                 header_.source_positions);
        header_.guard_band = guard_band_.band;
    }
    if (settings.exposure <= 0.0F) {
        header_.settings.exposure = 1.0F;
        header_.settings.exposure = render::auto_exposure(grid_renderer_, source_renderer_.render(header_));
    }
}

Views LightFieldRun::render(std::uint32_t frame, const std::vector<LatticePosition>& positions) {
    header_.frame_id = frame;
    header_.noise_frame = frame;
    header_.scene_time_ns = scene_.gpu_scene().current_pose().time_ns;
    header_.cut = frame == 0;
    header_.source = scene_.source();
    source_ = &source_renderer_.render(header_);
    return grid_renderer_.render(*source_, scene_.request(positions));
}

float choose_exposure(const gpu::Device& device, LightFieldScene& scene, float wanted, const BenchmarkScene& known) {
    if (wanted > 0.0F || known.exposure > 0.0F) {
        return wanted > 0.0F ? wanted : known.exposure;
    }
    RenderSettings automatic;
    automatic.exposure = 0.0F;
    return LightFieldRun(device, scene, automatic, false).header().settings.exposure;
}

HoleFilling parse_holes(const std::string& text, const ViewGrid& grid) {
    const auto holes = parse_hole_filling(text, grid.rows, grid.cols);
    if (!holes) {
        throw UserError("--holes " + text +
                        ": expected all, none or a list of previous,isolated,cascade,source,denoise");
    }
    return *holes;
}

} // namespace fieldcast::bench
