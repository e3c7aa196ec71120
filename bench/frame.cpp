// SPDX-License-Identifier: Apache-2.0
// `fieldcast-bench frame`: where the time of one frame goes, stage by stage (the paper's figure 3).
#include "bench/commands.h"
#include "bench/measure.h"
#include "core/base/error.h"
#include "core/image/image_file.h"
#include "core/render/setup.h"
#include "core/render/source_renderer.h"
#include "core/scene/gltf_loader.h"

#include <cmath>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <map>

namespace fieldcast::bench {

namespace {

struct FrameOptions {
    std::string scene = "scenes/atelier/atelier.gltf";
    std::string environment;
    std::string grid = "6x6";
    std::string size = "1280x720";
    std::string device;
    std::string traversal = "auto";
    std::string json;
    std::string out;
    std::uint32_t frames = 8;
    std::uint32_t warm_up = 2;
    double spacing_m = 0.0;
    double exposure = 0.0;
    bool guard_band = true;
    std::string holes = "all";
    RenderSettings settings;
};

/// What one frame took and did.
struct FrameSample {
    std::vector<StageTime> stages{};
    double source_paths = 0.0; ///< paths that start on a surface
    double hole_paths = 0.0;
    double hole_pixels = 0.0;
    double synthesised_pixels = 0.0; ///< of all views but the source's own
};

double stage_ms(const FrameSample& sample, const std::string& stage) {
    double ms = 0.0;
    for (const StageTime& time : sample.stages) {
        ms += time.stage == stage ? time.ms : 0.0;
    }
    return ms;
}

double frame_ms(const FrameSample& sample) {
    double ms = 0.0;
    for (const StageTime& time : sample.stages) {
        ms += time.ms;
    }
    return ms;
}

std::uint64_t surface_pixels(const render::SourcePlanes& planes) {
    const SourceFrame frame = planes.download(std::array{PlaneSemantic::kId});
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < frame.planes[0].bytes.size(); i += 4) {
        std::uint32_t id = 0;
        std::memcpy(&id, &frame.planes[0].bytes[i], sizeof id);
        count += id != 0xFFFFFFFFU ? 1U : 0U;
    }
    return count;
}

/// Renders frames of one scene and grid, one after the other.
class FrameRun {
public:
    FrameRun(const gpu::Device& device, const FrameOptions& options)
        : options_(options), size_(parse_size("--size", options.size)), scene_(load(options)),
          camera_(find_camera(scene_)),
          gpu_scene_(device, scene_, scene::choose_traversal(device, options.traversal)),
          source_renderer_(device, gpu_scene_), grid_renderer_(device, gpu_scene_) {
        if (camera_ == nullptr) {
            throw UserError(options.scene + ": has no camera");
        }
        choose_grid();
        header_.settings = options.settings;
        choose_holes();
        pose(0);
        if (options.guard_band) {
            guard_band_ = render::measure_guard_band(device, gpu_scene_, header_.source, grid_);
            header_.guard_band = guard_band_.band;
        }
        header_.settings.exposure = static_cast<float>(options.exposure);
        if (options.exposure <= 0.0) {
            header_.settings.exposure = 1.0F;
            header_.settings.exposure = render::auto_exposure(grid_renderer_, source_renderer_.render(header_));
        }
    }

    FrameSample render(std::uint32_t frame) {
        pose(frame);
        const render::SourcePlanes& planes = source_renderer_.render(header_);
        const render::ViewRequest request{grid_.geometry, vertical_fov(header_.source), size_.width_px, size_.height_px,
                                          lattice_positions(grid_)};
        views_ = grid_renderer_.render(planes, request);
        FrameSample sample{.stages = views_.header.render_times};
        const double spp = header_.settings.samples_per_pixel;
        sample.source_paths = static_cast<double>(surface_pixels(planes)) * spp;
        for (const View& view : views_.views) {
            sample.hole_pixels += view.discards.total();
        }
        sample.hole_paths = static_cast<double>(grid_renderer_.hole_counts().traced) * spp;
        sample.synthesised_pixels = static_cast<double>(grid_.view_count() - 1) * size_.width_px * size_.height_px;
        return sample;
    }

    void write_views(const std::filesystem::path& folder) const {
        std::filesystem::create_directories(folder);
        for (std::size_t i = 0; i < views_.views.size(); ++i) {
            const std::string name = std::to_string(i / grid_.cols) + "_" + std::to_string(i % grid_.cols);
            image::write_png(folder / ("view_" + name + ".png"), views_.views[i].image);
        }
    }

    const GuardBandChoice& guard_band() const { return guard_band_; }
    std::uint64_t invalid_samples() const {
        return source_renderer_.invalid_sample_count() + grid_renderer_.invalid_sample_count();
    }

private:
    static scene::Scene load(const FrameOptions& options) {
        scene::LoadOptions load;
        if (!options.environment.empty()) {
            load.environment = options.environment;
        }
        return scene::load_scene(options.scene, load);
    }

    void choose_grid() {
        const std::optional<ViewGrid> parsed = parse_grid(options_.grid);
        if (!parsed) {
            throw UserError("--grid " + options_.grid + ": expected ROWSxCOLUMNS");
        }
        grid_ = *parsed;
        const float default_m = camera_->spacing_m.value_or(0.03F);
        grid_.geometry.spacing_m = glm::vec2(options_.spacing_m > 0.0 ? static_cast<float>(options_.spacing_m) : default_m);
        if (const auto problem = grid_problem(grid_)) {
            throw UserError("--grid: " + *problem);
        }
    }

    void choose_holes() {
        const auto holes = parse_hole_filling(options_.holes, grid_.rows, grid_.cols);
        if (!holes) {
            throw UserError("--holes " + options_.holes +
                            ": expected all, none or a list of previous,isolated,cascade,source,denoise");
        }
        header_.settings.holes = *holes;
    }

    void pose(std::uint32_t frame) {
        header_.frame_id = frame;
        header_.noise_frame = frame;
        header_.scene_time_ns = static_cast<std::int64_t>(frame) * 1'000'000'000 / 30;
        header_.cut = frame == 0;
        gpu_scene_.pose(header_.scene_time_ns, header_.cut);
        header_.source = render::source_camera(gpu_scene_, *camera_, size_.width_px, size_.height_px);
    }

    FrameOptions options_;
    Size size_;
    scene::Scene scene_;
    const scene::CameraNode* camera_;
    scene::GpuScene gpu_scene_;
    render::SourceRenderer source_renderer_;
    render::GridRenderer grid_renderer_;
    ViewGrid grid_;
    FrameHeader header_;
    GuardBandChoice guard_band_;
    Views views_;
};

nlohmann::ordered_json summarise(const gpu::Device& device, const FrameOptions& options,
                                 const std::vector<FrameSample>& samples) {
    const auto of = [&](auto value) {
        std::vector<double> values;
        for (const FrameSample& sample : samples) {
            values.push_back(value(sample));
        }
        return median(values);
    };
    const auto ns_per = [](double ms, double paths) { return paths > 0.0 ? ms * 1e6 / paths : 0.0; };
    nlohmann::ordered_json json;
    json["device"] = device.info().name + ", " + device.info().driver;
    json["scene"] = options.scene;
    json["grid"] = options.grid;
    json["size"] = options.size;
    for (const StageTime& time : samples.front().stages) {
        json["stages_ms"][time.stage] = of([&](const FrameSample& s) { return stage_ms(s, time.stage); });
    }
    json["frame_ms"] = of(frame_ms);
    json["hole_share"] = of([](const FrameSample& s) { return s.hole_pixels / std::max(1.0, s.synthesised_pixels); });
    json["traced_share"] = of([](const FrameSample& s) { return s.hole_paths / std::max(1.0, s.synthesised_pixels); });
    json["ns_per_source_path"] =
        of([&](const FrameSample& s) { return ns_per(stage_ms(s, "source_trace"), s.source_paths); });
    json["ns_per_hole_path"] = of([&](const FrameSample& s) { return ns_per(stage_ms(s, "holes"), s.hole_paths); });
    json["peak_rss_bytes"] = peak_rss_bytes();
    return json;
}

void print_table(const nlohmann::ordered_json& json) {
    const double total = json["frame_ms"];
    std::cout << std::fixed << std::setprecision(1) << "stage                    ms   share\n";
    for (const auto& [stage, ms] : json["stages_ms"].items()) {
        const double share = ms.get<double>() / std::max(total, 1e-9);
        std::cout << std::left << std::setw(18) << stage << std::right << std::setw(9) << ms.get<double>()
                  << std::setw(6) << 100.0 * share << " %  " << std::string(static_cast<std::size_t>(share * 50.0), '#')
                  << '\n';
    }
    const double source_ns = json["ns_per_source_path"];
    const double hole_ns = json["ns_per_hole_path"];
    std::cout << "frame             " << std::setw(9) << total << '\n'
              << std::setprecision(2) << "holes: " << 100.0 * json["hole_share"].get<double>()
              << " % of the synthesised pixels, path traced " << 100.0 * json["traced_share"].get<double>() << " %\n"
              << std::setprecision(0) << "per path: source " << source_ns << " ns, hole " << hole_ns << " ns (ratio "
              << std::setprecision(2) << hole_ns / std::max(source_ns, 1e-9) << ", target 1.30)\n"
              << "peak memory: " << json["peak_rss_bytes"].get<double>() / 1048576.0 << " MiB\n";
}

void run_frame(const FrameOptions& options) {
    const gpu::Device device({.name_contains = options.device});
    FrameRun run(device, options);
    std::cout << device.info().name << ", " << device.info().driver << '\n'
              << options.scene << ", " << options.grid << " views of " << options.size << '\n';
    const GuardBandChoice& guard = run.guard_band();
    std::cout << "guard band: left " << guard.band.left_px << ", right " << guard.band.right_px << ", top "
              << guard.band.top_px << ", bottom " << guard.band.bottom_px << " pixels (" << std::llround(100.0 * guard.extra_share) << " % more source pixels, "
              << std::llround(100.0 * guard.removed_share) << " % of the out-of-frustum pixels removed)\n";
    std::vector<FrameSample> samples;
    for (std::uint32_t frame = 0; frame < options.warm_up + options.frames; ++frame) {
        const FrameSample sample = run.render(frame);
        if (frame >= options.warm_up) {
            samples.push_back(sample);
        }
        std::cerr << "\rframe " << frame + 1 << " of " << options.warm_up + options.frames << std::flush;
    }
    std::cerr << '\n';
    const nlohmann::ordered_json json = summarise(device, options, samples);
    print_table(json);
    if (run.invalid_samples() > 0) {
        std::cout << "invalid samples: " << run.invalid_samples() << '\n';
    }
    if (!options.json.empty()) {
        write_json(options.json, json);
    }
    if (!options.out.empty()) {
        run.write_views(options.out);
    }
}

} // namespace

void add_frame_command(CLI::App& app) {
    auto options = std::make_shared<FrameOptions>();
    CLI::App* command = app.add_subcommand("frame", "Stage times of one frame; medians over frames after warm-up");
    command->add_option("--scene", options->scene, "glTF file")->capture_default_str();
    command->add_option("--environment", options->environment, ".hdr or .exr environment");
    command->add_option("--grid", options->grid, "ROWSxCOLUMNS of views")->capture_default_str();
    command->add_option("--size", options->size, "size of source and views")->capture_default_str();
    command->add_option("--spacing", options->spacing_m, "metres between views (default: the camera's, else 0.03)");
    command->add_option("--exposure", options->exposure, "default: automatic");
    command->add_option("--frames", options->frames, "frames measured")->check(CLI::Range(1, 100000))->capture_default_str();
    command->add_option("--warm-up", options->warm_up, "frames before them")->capture_default_str();
    command->add_option("--spp", options->settings.samples_per_pixel)->check(CLI::Range(1, 4096))->capture_default_str();
    command->add_option("--bounces", options->settings.max_bounces)->check(CLI::Range(1, 64))->capture_default_str();
    command->add_flag("!--no-nee", options->settings.next_event_estimation, "without next event estimation");
    command->add_flag("!--no-guard-band", options->guard_band, "source without guard band, as in the paper");
    command->add_option("--holes", options->holes,
                        "all, none (path traced), or a list of previous,isolated,cascade,source,denoise")
        ->capture_default_str();
    command->add_option("--device", options->device, "part of the Vulkan device's name");
    command->add_option("--traversal", options->traversal, "auto, bvh or rayquery")->capture_default_str();
    command->add_option("--json", options->json, "write the results to this file");
    command->add_option("--out", options->out, "write the last frame's views to this folder");
    command->callback([options] { run_frame(*options); });
}

} // namespace fieldcast::bench
