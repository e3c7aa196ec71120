// SPDX-License-Identifier: Apache-2.0
// `fieldcast-bench holes`: savings and errors of each stage of hole filling.
#include "bench/commands.h"
#include "bench/light_field_run.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>

namespace fieldcast::bench {

namespace {

struct HoleOptions {
    std::string scene = "atelier";
    std::string grid = "6x6";
    std::string size = "640x360";
    std::string device;
    std::string json;
    std::uint32_t frames = 12;
    std::uint32_t reference_samples = 64;
};

/// One choice of stages and its results over the measured frames.
struct Variant {
    std::string name;
    HoleFilling holes;
    std::unique_ptr<render::GridRenderer> renderer{};
    double pixels = 0.0; ///< of all views
    double hole_pixels = 0.0;
    double traced = 0.0;
    double trace_ms = 0.0;
    double fill_ms = 0.0;       ///< trace_ms included
    double squared_error = 0.0; ///< display-referred, over hole pixels and channels
    double error = 0.0;
};

std::vector<Variant> make_variants(const ViewGrid& grid) {
    HoleFilling all;
    all.cascade_rows = grid.rows;
    all.cascade_cols = grid.cols;
    std::vector<Variant> variants;
    variants.push_back({.name = "path traced", .holes = HoleFilling::path_traced()});
    variants.push_back({.name = "all stages", .holes = all});
    const auto add_without = [&](const std::string& name, auto change) {
        HoleFilling holes = all;
        change(holes);
        variants.push_back({.name = "without " + name, .holes = holes});
    };
    add_without("previous frame", [](HoleFilling& h) { h.previous_frame = false; });
    add_without("isolated", [](HoleFilling& h) { h.isolated = false; });
    add_without("cascade", [](HoleFilling& h) { h.cascade_rows = h.cascade_cols = 0; });
    add_without("end in source", [](HoleFilling& h) { h.end_in_source = false; });
    add_without("denoise", [](HoleFilling& h) { h.denoise = false; });
    return variants;
}

double display(float linear, float exposure) { // clamp and sRGB curve
    const double x = std::clamp(static_cast<double>(linear * exposure), 0.0, 1.0);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
}

class HoleRun {
public:
    HoleRun(const gpu::Device& device, const HoleOptions& options)
        : scene_(device, {.file = find_benchmark_scene(options.scene).file,
                          .grid = options.grid,
                          .size = parse_size("--size", options.size)}),
          source_(device, scene_.gpu_scene()), planes_(device), reference_(device, scene_.gpu_scene()),
          variants_(make_variants(scene_.grid())) {
        for (Variant& variant : variants_) {
            variant.renderer = std::make_unique<render::GridRenderer>(device, scene_.gpu_scene());
        }
        pose(0);
        header_.guard_band =
            render::measure_guard_band(device, scene_.gpu_scene(), header_.source, scene_.grid()).band;
        header_.settings.exposure = render::auto_exposure(reference_, source_.render(header_));
    }

    /// Renders the frame with every variant. If `reference_samples` > 0, holes are compared with ones of that many
    /// samples.
    void render(std::uint32_t frame, std::uint32_t reference_samples) {
        pose(frame);
        SourceFrame wire = source_.render(header_).download(render::kSourceSemantics);
        const render::ViewRequest request = scene_.request(lattice_positions(scene_.grid()));
        if (reference_samples > 0) {
            wire.header.settings.holes = HoleFilling::path_traced();
            wire.header.settings.samples_per_pixel = reference_samples;
            wire.header.settings.indirect_clamp = 0.0F;
            wire.header.seed = header_.seed + 1;
            make_views(reference_, wire, request);
            wire.header = header_;
            wire.header.layer_count = planes_.header().layer_count;
        }
        for (Variant& variant : variants_) {
            wire.header.settings.holes = variant.holes;
            const Views views = make_views(*variant.renderer, wire, request);
            if (reference_samples > 0) {
                score(variant, views);
            }
        }
    }

    const std::vector<Variant>& variants() const { return variants_; }

private:
    void pose(std::uint32_t frame) {
        header_.frame_id = header_.noise_frame = frame;
        header_.scene_time_ns = static_cast<std::int64_t>(frame) * 1'000'000'000 / 30;
        header_.cut = frame == 0;
        scene_.pose(frame);
        header_.source = scene_.source();
    }

    Views make_views(render::GridRenderer& renderer, const SourceFrame& wire, const render::ViewRequest& request) {
        if (const auto taken = planes_.upload(wire); !taken) {
            throw std::runtime_error("source planes: " + taken.error().message);
        }
        return renderer.render(planes_, request);
    }

    void score(Variant& variant, const Views& views) const {
        for (const StageTime& time : views.header.render_times) {
            const bool is_fill = time.stage == "holes" || time.stage.ends_with("_holes");
            variant.trace_ms += time.stage == "holes" ? time.ms : 0.0;
            variant.fill_ms += is_fill ? time.ms : 0.0;
        }
        const render::HoleCounts counts = variant.renderer->hole_counts();
        variant.traced += static_cast<double>(counts.traced);
        variant.hole_pixels += static_cast<double>(counts.holes);
        variant.pixels += static_cast<double>(views.views.size()) * scene_.size().width_px * scene_.size().height_px;
        for (std::size_t i = 0; i < views.views.size(); ++i) {
            add_errors(variant, i);
        }
    }

    void add_errors(Variant& variant, std::size_t view) const {
        const std::vector<bool> mask = variant.renderer->hole_mask(view);
        const auto ours = variant.renderer->linear_view(view).pixels;
        const auto theirs = reference_.linear_view(view).pixels;
        for (std::size_t i = 0; i < mask.size(); ++i) {
            for (int c = 0; mask[i] && c < 3; ++c) {
                const float exposure = header_.settings.exposure;
                const double difference = display(ours[i][c], exposure) - display(theirs[i][c], exposure);
                variant.squared_error += difference * difference / 3.0;
                variant.error += difference / 3.0;
            }
        }
    }

    LightFieldScene scene_;
    render::SourceRenderer source_;
    render::SourcePlanes planes_;
    render::GridRenderer reference_;
    FrameHeader header_;
    std::vector<Variant> variants_;
};

nlohmann::ordered_json to_json(const Variant& v, std::uint32_t frames) {
    const double holes = std::max(1.0, v.hole_pixels);
    return {{"variant", v.name},
            {"hole_share", v.hole_pixels / v.pixels},
            {"traced_share", v.traced / v.pixels},
            {"trace_ms", v.trace_ms / frames},
            {"fill_ms", v.fill_ms / frames},
            {"ns_per_traced_path", v.trace_ms * 1e6 / std::max(1.0, v.traced)},
            {"hole_rmse", std::sqrt(v.squared_error / holes)},
            {"hole_bias", v.error / holes}};
}

void run_holes(const HoleOptions& options) {
    const gpu::Device device({.name_contains = options.device});
    HoleRun run(device, options);
    constexpr std::uint32_t kScored = 2; // the last frames, in which histories are settled
    for (std::uint32_t frame = 0; frame < options.frames; ++frame) {
        run.render(frame, frame + kScored >= options.frames ? options.reference_samples : 0);
        std::cerr << "\rframe " << frame + 1 << " of " << options.frames << std::flush;
    }
    std::cerr << '\n';
    std::cout << device.info().name << ", " << device.info().driver << '\n'
              << options.scene << ", " << options.grid << " views of " << options.size << ", last " << kScored << " of "
              << options.frames << " frames against holes of " << options.reference_samples << " samples\n"
              << "stages                   holes  traced   fill ms  trace ms  ns/path  RMSE of holes    bias\n"
              << std::fixed;
    nlohmann::ordered_json json{{"device", device.info().name}, {"scene", options.scene}, {"grid", options.grid},
                                {"size", options.size}};
    for (const Variant& variant : run.variants()) {
        const nlohmann::ordered_json row = to_json(variant, kScored);
        const auto of = [&](const char* key) { return row[key].get<double>(); };
        std::cout << std::left << std::setw(22) << variant.name << std::right << std::setprecision(2) << std::setw(6)
                  << 100.0 * of("hole_share") << " %" << std::setw(6) << 100.0 * of("traced_share") << " %"
                  << std::setprecision(1) << std::setw(9) << of("fill_ms") << std::setw(10) << of("trace_ms")
                  << std::setprecision(0) << std::setw(9) << of("ns_per_traced_path") << std::setprecision(4)
                  << std::setw(15) << of("hole_rmse") << std::setw(8) << of("hole_bias") << '\n';
        json["variants"].push_back(row);
    }
    if (!options.json.empty()) {
        write_json(options.json, json);
    }
}

} // namespace

void add_holes_command(CLI::App& app) {
    auto options = std::make_shared<HoleOptions>();
    CLI::App* command = app.add_subcommand("holes", "Savings and remaining error of each stage of hole filling.");
    command->add_option("--scene", options->scene, describe_scene_option())->capture_default_str();
    command->add_option("--grid", options->grid, "Grid of views, ROWSxCOLUMNS.")->capture_default_str();
    command->add_option("--size", options->size, "Size of source and views in pixels, WIDTHxHEIGHT.")
        ->capture_default_str();
    command->add_option("--frames", options->frames, "Number of rendered frames; the last two are measured.")
        ->check(CLI::Range(2, 1000))
        ->capture_default_str();
    command->add_option("--reference-spp", options->reference_samples, "Samples per pixel of the reference for holes.")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    command->add_option("--device", options->device, "Part of the name of the Vulkan device.");
    command->add_option("--json", options->json, "Write the results to this JSON file.");
    command->callback([options] { run_holes(*options); });
}

} // namespace fieldcast::bench
