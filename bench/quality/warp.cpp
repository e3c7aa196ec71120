// SPDX-License-Identifier: Apache-2.0
// `fieldcast-bench warp`: compares views made from colour and depth with views made with the scene: bytes, errors,
// time.
#include "bench/commands.h"
#include "bench/csv.h"
#include "bench/provenance.h"
#include "bench/quality/warp_run.h"
#include "bench/quality_table.h"

#include <iomanip>
#include <iostream>

namespace fieldcast::bench {

namespace {

struct WarpOptions {
    std::string scene = "atelier";
    std::string grid = "6x6";
    std::string size = "640x360";
    std::string device;
    std::string json;
    std::string csv;
    WarpSettings settings;
};

void print_table(const nlohmann::ordered_json& json) {
    std::cout << "source with guard band " << json["source_size"].get<std::string>() << ", " << json["tiles"]
              << " residual tiles, " << json["view_count"] << " views made; bytes of planes, lossless: "
              << json["plane_bytes"] << '\n'
              << "mode               coding        bytes    SSIM  worst SSIM    RMSE  residual %  extended %"
                 "  ms/view\n";
    for (const nlohmann::ordered_json& row : json["rows"]) {
        const auto text = [&](const char* key, int digits) {
            return number_text(row.contains(key) ? row[key] : nlohmann::ordered_json(), digits);
        };
        std::cout << std::left << std::setw(19) << row["mode"].get<std::string>() << std::setw(8)
                  << row["coding"].get<std::string>() << std::right << std::setw(11) << text("bytes", 0) << std::setw(8)
                  << text("ssim", 4) << std::setw(12) << text("worst_ssim", 4) << std::setw(8) << text("rmse", 4)
                  << std::setw(12) << text("residual_percent", 3) << std::setw(12) << text("extended_percent", 3)
                  << std::setw(9) << text("ms_per_view", 1) << '\n';
    }
}

void run_warp(const WarpOptions& options) {
    const BenchmarkScene known = find_benchmark_scene(options.scene);
    WarpSettings settings = options.settings;
    settings.exposure = known.exposure;
    const gpu::Device device({.name_contains = options.device});
    LightFieldScene scene(device,
                          {.file = known.file, .grid = options.grid, .size = parse_size("--size", options.size)});
    WarpRun run(device, scene, settings);
    std::cout << device.info().name << ", " << device.info().driver << '\n'
              << known.title << ", " << options.grid << " views of " << options.size << std::endl;
    run.run();
    nlohmann::ordered_json json = provenance(device);
    json["scene"] = known.title;
    json["grid"] = options.grid;
    json["size"] = options.size;
    json.update(run.result());
    print_table(json);
    if (!options.json.empty()) {
        write_json(options.json, json);
    }
    if (!settings.out.empty()) {
        write_json((settings.out / "warp.json").string(), json);
    }
    if (!options.csv.empty()) {
        write_csv(options.csv,
                  {"machine", "commit", "command", "scene", "size", "mode", "coding", "bytes", "ssim", "worst_ssim",
                   "rmse", "flip", "residual_percent", "extended_percent", "ms_per_view"},
                  csv_rows(csv_origin_with_size(json), json["rows"]));
    }
}

} // namespace

void add_warp_command(CLI::App& app) {
    auto options = std::make_shared<WarpOptions>();
    CLI::App* command = app.add_subcommand("warp", "Bytes, errors and time of views made without the scene.");
    command->add_option("--scene", options->scene, describe_scene_option())->capture_default_str();
    command->add_option("--grid", options->grid, "Grid of views, ROWSxCOLUMNS; its corners and inner views are made.")
        ->capture_default_str();
    command->add_option("--size", options->size, "Size of source and views in pixels, WIDTHxHEIGHT.")
        ->capture_default_str();
    command->add_option("--frames", options->settings.frames,
                        "Number of frames from a cold start; the last one is measured.")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_option("--qualities", options->settings.qualities, "Qualities of lossy codecs, each 1 to 100.")
        ->delimiter(',')
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    command->add_option("--out", options->settings.out,
                        "Write the views and warp.json to this folder, for `./fieldcast bench flip`.");
    command->add_option("--device", options->device, "Part of the name of the Vulkan device.");
    command->add_option("--json", options->json, "Write the results to this JSON file.");
    command->add_option("--csv", options->csv, "Write one line per row to this CSV file.");
    command->callback([options] { run_warp(*options); });
}

} // namespace fieldcast::bench
