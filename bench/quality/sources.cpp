// SPDX-License-Identifier: Apache-2.0
// `fieldcast-bench sources`: quality and cost for different choices of path traced views (the paper's figure 5).
#include "bench/commands.h"
#include "bench/csv.h"
#include "bench/pages/sources_page.h"
#include "bench/provenance.h"
#include "bench/quality/protocol_options.h"
#include "bench/quality/sources_run.h"
#include "bench/quality_table.h"
#include "core/lightfield/presets.h"

#include <iomanip>
#include <iostream>

namespace fieldcast::bench {

namespace {

struct SourcesOptions {
    ProtocolOptions protocol;
    std::vector<std::string> configurations{"middle", "top-left", "diagonal", "triangle", "corners"};
    std::string preset = "default";
    std::string json;
    std::string csv;
    std::string html;
    std::string out;
    double exposure = 0.0;
    bool scores_all_views = false;
};

const std::vector<std::string> kColumns{"machine",      "commit",     "command", "scene", "protocol",
                                        "preset",       "sources",    "rmse",    "ssim",  "discard_share",
                                        "traced_share", "hole_paths", "frame_ms"};

void print_table(const nlohmann::ordered_json& result) {
    std::cout << "\nsources         RMSE    SSIM   discards   traced  hole paths     frame\n";
    for (const auto& row : result["sources"]) {
        const auto percent = [&](const char* key) { return number_text(100.0 * row[key].get<double>(), 2) + " %"; };
        std::cout << std::left << std::setw(12) << row["sources"].get<std::string>() << std::right << std::setw(8)
                  << number_text(row["rmse"], 4) << std::setw(8) << number_text(row["ssim"], 4) << std::setw(11)
                  << percent("discard_share") << std::setw(9) << percent("traced_share") << std::setw(12)
                  << number_text(row["hole_paths"], 0) << std::setw(7) << number_text(row["frame_ms"], 0) << " ms\n";
    }
}

void run_sources(const SourcesOptions& options) {
    const SourcesSettings settings{.scene = find_benchmark_scene(options.protocol.scene),
                                   .protocol = chosen_protocol(options.protocol),
                                   .references = options.protocol.references,
                                   .preset = options.preset,
                                   .configurations = options.configurations,
                                   .exposure = static_cast<float>(options.exposure),
                                   .scores_all_views = options.scores_all_views,
                                   .out = options.out};
    const gpu::Device device({.name_contains = options.protocol.device});
    SourcesRun run(device, settings);
    std::cout << device.info().name << ", " << device.info().driver << '\n'
              << settings.scene.title << ", " << options.preset << ", " << describe(settings.protocol) << std::endl;
    run.run();
    nlohmann::ordered_json json = provenance(device);
    json.update(run.result());
    print_table(json);
    std::cout << "invalid samples: " << run.invalid_samples() << '\n';
    if (!options.out.empty()) {
        std::filesystem::create_directories(options.out);
        run.write_heat_maps(json);
    }
    if (!options.json.empty()) {
        write_json(options.json, json);
    }
    if (!options.csv.empty()) {
        nlohmann::ordered_json first = csv_origin(json);
        first["preset"] = json["preset"];
        write_csv(options.csv, kColumns, csv_rows(first, json["sources"]));
    }
    if (!options.html.empty()) {
        sources_page(json).write(options.html);
    }
}

} // namespace

void add_sources_command(CLI::App& app) {
    auto options = std::make_shared<SourcesOptions>();
    CLI::App* command =
        app.add_subcommand("sources", "Quality and cost of source configurations (the paper's figure 5).");
    add_protocol_options(*command, options->protocol);
    command->add_option("--sources", options->configurations,
                        "Source configurations: middle, top-left, diagonal, triangle, corners, or views of 6x6 as in "
                        "\"0,0;5,5\".")
        ->expected(1, 16)
        ->capture_default_str();
    command->add_option("--preset", options->preset, "Preset that makes the views: " + preset_names() + ".")
        ->capture_default_str();
    command->add_option("--exposure", options->exposure,
                        "Exposure (default: that of the named scene; automatic for a file).");
    command->add_flag("--all-views", options->scores_all_views,
                      "Score all views of the last frame, for heat maps of RMSE and SSIM; needs their references.");
    command->add_option("--json", options->json, "Write the results to this JSON file.");
    command->add_option("--csv", options->csv, "Write the table to this CSV file.");
    command->add_option("--html", options->html, "Write a report with charts to this HTML file.");
    command->add_option(
        "--out", options->out,
        "Write heat maps to this folder: MEASURE_N.png for configuration N; dark is 0, bright is the largest value.");
    command->footer("\nExample:\n  ./fieldcast bench sources --scene sponza --sources middle corners --out heat_maps");
    command->callback([options] { run_sources(*options); });
}

} // namespace fieldcast::bench
