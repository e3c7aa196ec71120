// SPDX-License-Identifier: Apache-2.0
// `fieldcast-bench frame`: times of the stages of a frame (the paper's figure 3).
#include "bench/commands.h"
#include "bench/interrupt.h"
#include "bench/light_field_run.h"
#include "bench/pages/frame_page.h"
#include "bench/progress.h"
#include "bench/provenance.h"
#include "core/base/error.h"
#include "core/image/image_file.h"
#include "core/lightfield/presets.h"

#include <cmath>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <map>

namespace fieldcast::bench {

namespace {

struct FrameOptions {
    std::string scene = "atelier";
    std::string environment;
    std::string grid = "6x6";
    std::string size = "1280x720";
    std::string device;
    std::string traversal = "auto";
    std::string visibility = "auto";
    std::string json;
    std::string html;
    std::string out;
    std::uint32_t frames = 8;
    std::uint32_t warm_up = 2;
    double spacing_m = 0.0;
    double exposure = 0.0;
    bool guard_band = true;
    std::string preset = "default";
    std::string holes; ///< empty: the preset's
    RenderSettings settings; ///< only samples, bounces and next event estimation are used
};

/// The preset with the changes of the command line. Throws UserError.
Preset chosen_preset(const FrameOptions& options, const ViewGrid& grid, float exposure) {
    std::optional<Preset> preset = find_preset(options.preset, grid.rows, grid.cols);
    if (!preset) {
        throw UserError("--preset " + options.preset + ": expected one of " + preset_names());
    }
    RenderSettings& settings = preset->settings;
    settings.samples_per_pixel = options.settings.samples_per_pixel;
    settings.max_bounces = options.settings.max_bounces;
    settings.next_event_estimation = options.settings.next_event_estimation;
    settings.exposure = exposure;
    if (!options.holes.empty()) {
        settings.holes = parse_holes(options.holes, grid);
    }
    preset->has_guard_band = preset->has_guard_band && options.guard_band;
    return *preset;
}

/// Times and counts of one frame.
struct FrameSample {
    std::vector<StageTime> stages{};
    double source_paths = 0.0; ///< paths that start on a surface
    double hole_paths = 0.0;
    double hole_pixels = 0.0;
    double synthesised_pixels = 0.0; ///< pixels of all views except the source's own
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

FrameSample measure(LightFieldScene& scene, LightFieldRun& run, std::uint32_t frame, Views& views) {
    scene.pose(frame);
    views = run.render(frame, lattice_positions(scene.grid()));
    FrameSample sample{.stages = views.header.render_times};
    const double spp = views.header.settings.samples_per_pixel;
    sample.source_paths = static_cast<double>(surface_pixels(run.source())) * spp;
    for (const View& view : views.views) {
        sample.hole_pixels += view.discards.total();
    }
    sample.hole_paths = static_cast<double>(run.grid_renderer().hole_counts().traced) * spp;
    sample.synthesised_pixels =
        static_cast<double>(scene.grid().view_count() - 1) * scene.size().width_px * scene.size().height_px;
    return sample;
}

void write_views(const std::filesystem::path& folder, const ViewGrid& grid, const Views& views) {
    std::filesystem::create_directories(folder);
    for (std::size_t i = 0; i < views.views.size(); ++i) {
        const std::string name = std::to_string(i / grid.cols) + "_" + std::to_string(i % grid.cols);
        image::write_png(folder / ("view_" + name + ".png"), views.views[i].image);
    }
}

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
    nlohmann::ordered_json json = provenance(device);
    json["scene"] = find_benchmark_scene(options.scene).title;
    json["frames"] = samples.size();
    json["grid"] = options.grid;
    json["size"] = options.size;
    json["preset"] = options.preset;
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

void print_guard_band(const GuardBandChoice& guard) {
    std::cout << "guard band: left " << guard.band.left_px << ", right " << guard.band.right_px << ", top "
              << guard.band.top_px << ", bottom " << guard.band.bottom_px << " pixels ("
              << std::llround(100.0 * guard.extra_share) << " % more source pixels, "
              << std::llround(100.0 * guard.removed_share) << " % of the out-of-frustum pixels removed)" << std::endl;
}

/// Measures the frames after warm-up; `views` receives those of the last frame. Throws Interrupted.
std::vector<FrameSample> measure_frames(LightFieldScene& scene, LightFieldRun& run, const FrameOptions& options,
                                        Views& views) {
    std::vector<FrameSample> samples;
    const InterruptGuard interrupt;
    Progress progress("frames", options.warm_up + options.frames);
    for (std::uint32_t frame = 0; frame < options.warm_up + options.frames; ++frame) {
        const FrameSample sample = measure(scene, run, frame, views);
        if (frame >= options.warm_up) {
            samples.push_back(sample);
        }
        progress.add(1.0);
        if (interrupt.is_interrupted()) {
            throw Interrupted{"no results were written"};
        }
    }
    return samples;
}

void run_frame(const FrameOptions& options) {
    const gpu::Device device({.name_contains = options.device});
    const BenchmarkScene known = find_benchmark_scene(options.scene);
    LightFieldScene scene(device, {known.file, options.environment, options.grid, options.spacing_m, options.traversal,
                                   options.visibility, parse_size("--size", options.size)});
    const Preset preset = chosen_preset(
        options, scene.grid(), options.exposure > 0.0 ? static_cast<float>(options.exposure) : known.exposure);
    LightFieldRun run(device, scene, preset.settings, preset.has_guard_band);
    std::cout << device.info().name << ", " << device.info().driver << '\n'
              << known.title << ", " << options.grid << " views of " << options.size << '\n';
    print_guard_band(run.guard_band());
    Views views;
    const nlohmann::ordered_json json = summarise(device, options, measure_frames(scene, run, options, views));
    print_table(json);
    if (run.invalid_samples() > 0) {
        std::cout << "invalid samples: " << run.invalid_samples() << '\n';
    }
    if (!options.json.empty()) {
        write_json(options.json, json);
    }
    if (!options.html.empty()) {
        frame_page(json).write(options.html);
    }
    if (!options.out.empty()) {
        write_views(options.out, scene.grid(), views);
    }
}

} // namespace

void add_frame_command(CLI::App& app) {
    auto options = std::make_shared<FrameOptions>();
    CLI::App* command = app.add_subcommand("frame",
                                           "Stage times of one frame; medians over the frames after warm-up (the "
                                           "paper's figure 3).");
    command->add_option("--scene", options->scene, describe_scene_option())->capture_default_str();
    command->add_option("--environment", options->environment,
                        "Environment, a .hdr or .exr file (default: the scene's own).");
    command->add_option("--grid", options->grid, "Grid of views, ROWSxCOLUMNS.")->capture_default_str();
    command->add_option("--size", options->size, "Size of source and views in pixels, WIDTHxHEIGHT.")
        ->capture_default_str();
    command->add_option("--spacing", options->spacing_m,
                        "Distance of neighbouring views in metres (default: the camera's, else 0.03).");
    command->add_option("--exposure", options->exposure,
                        "Exposure (default: that of the named scene; automatic for a file).");
    command->add_option("--frames", options->frames, "Number of measured frames.")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    command->add_option("--warm-up", options->warm_up, "Number of frames before the measured ones.")
        ->capture_default_str();
    command->add_option("--spp", options->settings.samples_per_pixel, "Samples per pixel of the source.")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    command->add_option("--bounces", options->settings.max_bounces, "Largest number of bounces.")
        ->check(CLI::Range(1, 64))->capture_default_str();
    command->add_flag("!--no-nee", options->settings.next_event_estimation, "Disable next event estimation.");
    command->add_flag("!--no-guard-band", options->guard_band,
                      "Render the source without guard band, as in the paper.");
    command->add_option("--preset", options->preset, "Preset that makes the views: " + preset_names() + ".")
        ->capture_default_str();
    command->add_option("--holes", options->holes,
                        "Hole filling: all, none (path traced), or a list of "
                        "previous,isolated,cascade,source,denoise (default: the preset's).");
    command->add_option("--device", options->device, "Part of the name of the Vulkan device.");
    command->add_option("--traversal", options->traversal, "Ray traversal: auto, bvh or rayquery.")
        ->capture_default_str();
    command->add_option("--visibility", options->visibility,
                        "Visibility method for views: rays, raster, or auto (the faster one).")
        ->capture_default_str();
    command->add_option("--json", options->json, "Write the results to this JSON file.");
    command->add_option("--html", options->html, "Write a report with charts to this HTML file.");
    command->add_option("--out", options->out, "Write the views of the last frame to this folder.");
    command->callback([options] { run_frame(*options); });
}

} // namespace fieldcast::bench
