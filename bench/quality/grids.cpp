// SPDX-License-Identifier: Apache-2.0
// `fieldcast-bench grids`: quality and cost for different numbers of requested views (the paper's figure 4).
#include "bench/commands.h"
#include "bench/csv.h"
#include "bench/pages/grids_page.h"
#include "bench/provenance.h"
#include "bench/quality/grids_run.h"
#include "bench/quality/protocol_options.h"
#include "bench/quality_table.h"
#include "core/base/error.h"

#include <iomanip>
#include <iostream>

namespace fieldcast::bench {

namespace {

struct GridsOptions {
    ProtocolOptions protocol;
    std::vector<std::string> grids{"3x3", "4x4", "5x5", "6x6"};
    std::string preset = "default";
    std::string json;
    std::string csv;
    std::string html;
    double exposure = 0.0;
    bool scores_all_frames = false;
};

const std::vector<std::string> kColumns{
    "machine", "commit",   "command",    "scene",       "protocol",      "preset",       "grid",       "rmse",
    "ssim",    "ssim_min", "rmse_holes", "rmse_reused", "discard_share", "traced_share", "hole_paths", "frame_ms",
    "rmse_without_noise", "ssim_without_noise"};

std::vector<ViewGrid> parse_grids(const std::vector<std::string>& texts) {
    std::vector<ViewGrid> grids;
    for (const std::string& text : texts) {
        const auto grid = parse_grid(text);
        if (!grid) {
            throw UserError("--grids " + text + ": expected ROWSxCOLUMNS");
        }
        if (const auto problem = grid_problem(*grid)) {
            throw UserError("--grids: " + *problem);
        }
        grids.push_back(*grid);
    }
    return grids;
}

GridsSettings settings_of(const GridsOptions& options) {
    GridsSettings settings{.scene = find_benchmark_scene(options.protocol.scene),
                           .protocol = chosen_protocol(options.protocol),
                           .references = options.protocol.references,
                           .preset = options.preset,
                           .grids = parse_grids(options.grids),
                           .exposure = static_cast<float>(options.exposure)};
    if (!options.scores_all_frames) {
        settings.protocol.frames = {settings.protocol.frames.back()};
    }
    return settings;
}

void print_table(const nlohmann::ordered_json& result) {
    std::cout << "\ngrid      RMSE    SSIM   SSIM*  worst view   discards   traced  hole paths     frame\n";
    for (const auto& row : result["grids"]) {
        const auto percent = [&](const char* key) { return number_text(100.0 * row[key].get<double>(), 2) + " %"; };
        std::cout << std::left << std::setw(6) << row["grid"].get<std::string>() << std::right << std::setw(8)
                  << number_text(row["rmse"], 4) << std::setw(8) << number_text(row["ssim"], 4) << std::setw(8)
                  << number_text(row["ssim_without_noise"], 4) << std::setw(12) << number_text(row["ssim_min"], 4)
                  << std::setw(11) << percent("discard_share") << std::setw(9)
                  << percent("traced_share") << std::setw(12) << number_text(row["hole_paths"], 0) << std::setw(7)
                  << number_text(row["frame_ms"], 0) << " ms\n";
    }
    std::cout << "SSIM lost from " << result["grids"].front()["grid"].get<std::string>() << " to "
              << result["grids"].back()["grid"].get<std::string>() << ": " << number_text(result["ssim_lost"], 4)
              << " (paper, figure 4: hardly any), SSIM* " << number_text(result["ssim_lost_without_noise"], 4)
              << "\n* estimated without the noise of the references\n";
}

void run_grids(const GridsOptions& options) {
    const GridsSettings settings = settings_of(options);
    const gpu::Device device({.name_contains = options.protocol.device});
    GridsRun run(device, settings);
    std::cout << device.info().name << ", " << device.info().driver << '\n'
              << settings.scene.title << ", " << options.preset << ", " << to_string(settings.protocol.size) << ", "
              << settings.protocol.frames.size() << " frames, all views, references of "
              << settings.protocol.reference_samples << " samples" << std::endl;
    run.run();
    nlohmann::ordered_json json = provenance(device);
    json.update(run.result());
    print_table(json);
    std::cout << "invalid samples: " << run.invalid_samples() << '\n';
    if (!options.json.empty()) {
        write_json(options.json, json);
    }
    if (!options.html.empty()) {
        grids_page(json).write(options.html);
    }
    if (!options.csv.empty()) {
        nlohmann::ordered_json first = csv_origin(json);
        first["preset"] = json["preset"];
        write_csv(options.csv, kColumns, csv_rows(first, json["grids"]));
    }
}

} // namespace

void add_grids_command(CLI::App& app) {
    auto options = std::make_shared<GridsOptions>();
    CLI::App* command =
        app.add_subcommand("grids", "Quality and cost of grids of different sizes (the paper's figure 4).");
    add_protocol_options(*command, options->protocol);
    command->add_option("--grids", options->grids, "Grids of views, each ROWSxCOLUMNS.")->delimiter(',')
        ->capture_default_str();
    command->add_option("--preset", options->preset, "Preset that makes the views: " + preset_names() + ".")
        ->capture_default_str();
    command->add_option("--exposure", options->exposure,
                        "Exposure (default: that of the named scene; automatic for a file).");
    command->add_flag("--all-frames", options->scores_all_frames,
                      "Score all frames of the protocol, not only the last; needs references of all their views.");
    command->add_option("--json", options->json, "Write the results to this JSON file.");
    command->add_option("--csv", options->csv, "Write the table to this CSV file.");
    command->add_option("--html", options->html, "Write a report with charts to this HTML file.");
    command->footer(
        "\nEvery view of every grid is scored, so the references of all views are made first (36 for the default\n"
        "grids, slow without a GPU). They can be interrupted; the same command continues from there.");
    command->callback([options] { run_grids(*options); });
}

} // namespace fieldcast::bench
