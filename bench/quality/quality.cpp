// SPDX-License-Identifier: Apache-2.0
// `fieldcast-bench quality`: errors of views against references (the paper's table 1).
#include "bench/commands.h"
#include "bench/csv.h"
#include "bench/provenance.h"
#include "bench/quality/protocol_options.h"
#include "bench/quality/quality_run.h"
#include "bench/quality_table.h"

#include <iostream>

namespace fieldcast::bench {

namespace {

struct QualityOptions {
    ProtocolOptions protocol;
    std::string json;
    std::string csv;
    std::string html;
    std::string out;
    std::vector<std::string> presets{"reprojected", "svgf", "bmfr", "default"};
    double exposure = 0.0;
    double indirect_clamp = -1.0; ///< < 0: the presets'
    bool renders_scored_views_only = false;
    bool has_temporal = false;
    bool has_light_field = false;
};

QualitySettings settings_of(const QualityOptions& options) {
    return {.scene = find_benchmark_scene(options.protocol.scene),
            .protocol = chosen_protocol(options.protocol),
            .references = options.protocol.references,
            .presets = options.presets,
            .exposure = static_cast<float>(options.exposure),
            .indirect_clamp = static_cast<float>(options.indirect_clamp),
            .renders_scored_views_only = options.renders_scored_views_only,
            .has_temporal = options.has_temporal,
            .has_light_field = options.has_light_field,
            .out = options.out};
}

void run_quality(const QualityOptions& options) {
    const QualitySettings settings = settings_of(options);
    const gpu::Device device({.name_contains = options.protocol.device});
    QualityRun run(device, settings);
    std::cout << device.info().name << ", " << device.info().driver << '\n'
              << settings.scene.title << ", " << describe(settings.protocol) << std::endl;
    run.run();
    nlohmann::ordered_json json = provenance(device);
    json.update(run.result());
    print_quality_table(std::cout, json);
    std::cout << "invalid samples: " << run.invalid_samples() << '\n';
    if (!options.out.empty()) {
        write_json((std::filesystem::path(options.out) / "quality.json").string(), json);
    }
    if (!options.json.empty()) {
        write_json(options.json, json);
    }
    if (!options.html.empty()) {
        quality_page(json, run.shown()).write(options.html);
    }
    if (!options.csv.empty()) {
        write_csv(options.csv, quality_columns(), quality_csv_rows(json));
    }
}

constexpr const char* kFooter = R"(
--temporal renders 38 more frames with scene and camera at rest and measures flicker in the last 8. It compares each
scored frame with the previous one (warped error). If `reference --temporal` has made references of the previous frames,
their own warped error is subtracted as well.

--light-field scores all 36 views of the last frame: errors of each view, consistency of neighbouring views, epipolar
slices and refocused images. It makes missing references of these views, which takes as long as twelve frames of the
reduced protocol and is slow without a GPU.

docs/measurements/metrics.md explains each number.)";

void add_measures(CLI::App& command, QualityOptions& options) {
    command.add_flag("--scored-views", options.renders_scored_views_only,
                     "Render the scored views only: faster, but frame times and shares are not those of 6x6.");
    command.add_flag("--temporal", options.has_temporal, "Also measure warped error and flicker (slower, see below).");
    command.add_flag("--light-field", options.has_light_field,
                     "Also score all views of the last frame, alone and as a light field (slow, see below).");
    command.footer(kFooter);
}

} // namespace

void add_quality_command(CLI::App& app) {
    auto options = std::make_shared<QualityOptions>();
    CLI::App* command =
        app.add_subcommand("quality", "RMSE and SSIM of views against references (the paper's table 1).");
    add_protocol_options(*command, options->protocol);
    command->add_option("--presets", options->presets,
                        "Presets, the rows of the table besides 1 spp: " + preset_names() + ".")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--exposure", options->exposure,
                        "Exposure (default: that of the named scene; automatic for a file).");
    command->add_option("--indirect-clamp", options->indirect_clamp,
                        "Clamp of indirect light; 0: none (default: the presets').");
    add_measures(*command, *options);
    command->add_option("--json", options->json, "Write the results to this JSON file.");
    command->add_option("--csv", options->csv, "Write the table to this CSV file.");
    command->add_option("--html", options->html, "Write a report with charts and pictures to this HTML file.");
    command->add_option(
        "--out", options->out,
        "Write the scored views (PNG and EXR) and quality.json to this folder, for `./fieldcast bench flip`.");
    command->callback([options] { run_quality(*options); });
}

} // namespace fieldcast::bench
