// SPDX-License-Identifier: Apache-2.0
// `fieldcast-bench codecs`: bytes and times of planes and views in every codec, and errors of the lossy codecs.
#include "bench/commands.h"
#include "bench/csv.h"
#include "bench/provenance.h"
#include "bench/quality_table.h"
#include "bench/speed/codecs_run.h"
#include "core/base/error.h"

#include <iomanip>
#include <iostream>

namespace fieldcast::bench {

namespace {

struct CodecsOptions {
    std::string scene = "atelier";
    std::string grid = "6x6";
    std::string size = "640x360";
    std::string device;
    std::string json;
    std::string csv;
    CodecsSettings settings;
};

void print_table(const nlohmann::ordered_json& json) {
    std::cout << "source with guard band " << json["source_size"].get<std::string>() << "; means and medians over "
              << json["measured_frames"] << " frames, " << json["view_count"] << " views each; one thread\n"
              << "part        coding                bytes  encode ms  decode ms  SSIM of views  discards, points\n";
    for (const nlohmann::ordered_json& row : json["rows"]) {
        std::cout << std::left << std::setw(12) << row["part"].get<std::string>() << std::setw(17)
                  << row["coding"].get<std::string>() << std::right << std::setw(10) << number_text(row["bytes"], 0)
                  << std::setw(11) << number_text(row["encode_ms"], 2) << std::setw(11)
                  << number_text(row["decode_ms"], 2) << std::setw(15) << number_text(row["ssim"], 4) << std::setw(18)
                  << number_text(row["discard_points"], 3) << '\n';
    }
    const nlohmann::ordered_json& angle = json["coarse_normals_deg"];
    std::cout << "normals of 8 bits a component differ by " << number_text(angle["mean"], 3) << " degrees on average, "
              << number_text(angle["max"], 3) << " at most\n";
}

void write_results(const CodecsOptions& options, const nlohmann::ordered_json& json) {
    if (!options.json.empty()) {
        write_json(options.json, json);
    }
    if (!options.csv.empty()) {
        write_csv(options.csv,
                  {"machine", "commit", "command", "scene", "size", "part", "coding", "bytes", "encode_ms", "decode_ms",
                   "ssim", "discard_points"},
                  csv_rows(csv_origin_with_size(json), json["rows"]));
    }
}

void run_codecs(const CodecsOptions& options) {
    if (options.settings.measured > options.settings.frames) {
        throw UserError("--measured: must not exceed the " + std::to_string(options.settings.frames) + " of --frames");
    }
    const BenchmarkScene known = find_benchmark_scene(options.scene);
    CodecsSettings settings = options.settings;
    settings.exposure = known.exposure;
    const gpu::Device device({.name_contains = options.device});
    LightFieldScene scene(device,
                          {.file = known.file, .grid = options.grid, .size = parse_size("--size", options.size)});
    CodecsRun run(device, scene, settings);
    std::cout << device.info().name << ", " << device.info().driver << '\n'
              << known.title << ", " << options.grid << " views of " << options.size << std::endl;
    run.run();
    nlohmann::ordered_json json = provenance(device);
    json["scene"] = known.title;
    json["grid"] = options.grid;
    json["size"] = options.size;
    json.update(run.result());
    print_table(json);
    write_results(options, json);
}

} // namespace

void add_codecs_command(CLI::App& app) {
    auto options = std::make_shared<CodecsOptions>();
    CLI::App* command = app.add_subcommand("codecs", "Bytes and times of every codec, and errors of the lossy ones.");
    command->add_option("--scene", options->scene, describe_scene_option())->capture_default_str();
    command->add_option("--grid", options->grid,
                        "Grid of views, ROWSxCOLUMNS; its corners, an inner view and the source's are made.")
        ->capture_default_str();
    command->add_option("--size", options->size, "Size of source and views in pixels, WIDTHxHEIGHT.")
        ->capture_default_str();
    command->add_option("--frames", options->settings.frames, "Number of rendered frames, from a cold start.")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_option("--measured", options->settings.measured,
                        "Number of last frames that are encoded, at most --frames.")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_option("--qualities", options->settings.qualities, "Qualities of lossy codecs, each 1 to 100.")
        ->delimiter(',')
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    command->add_option("--device", options->device, "Part of the name of the Vulkan device.");
    command->add_option("--json", options->json, "Write the results to this JSON file.");
    command->add_option("--csv", options->csv, "Write one line per row to this CSV file.");
    command->callback([options] { run_codecs(*options); });
}

} // namespace fieldcast::bench
