// SPDX-License-Identifier: Apache-2.0
// `fieldcast-bench fanout`: CPU time of the server per additional client, against a bare gRPC stream.
#include "bench/commands.h"
#include "bench/csv.h"
#include "bench/fanout/fanout_run.h"
#include "bench/interrupt.h"
#include "bench/measure.h"
#include "bench/progress.h"
#include "bench/provenance.h"
#include "core/base/error.h"

#include <array>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <map>
#include <set>
#include <unistd.h>

namespace fieldcast::bench {

namespace {

using Json = nlohmann::ordered_json;

struct FanoutOptions {
    std::string json;
    std::string csv;
    fanout::FanoutSettings settings;
    double window_s = 2.0;
};

/// A temporary folder for this run; removed with its content.
struct TemporaryFolder {
    TemporaryFolder()
        : path(std::filesystem::temp_directory_path() / ("fieldcast-fanout-" + std::to_string(getpid()))) {
        std::filesystem::create_directories(path);
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    std::filesystem::path path;
};

constexpr const char* kDefaultRecording = ".cache/fanout.fcrec";

std::filesystem::path server_program() {
    return std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path() / "server/fieldcast-server";
}

/// Renders the default recording if it does not exist. Throws UserError if another recording does not exist.
void make_recording(const fanout::FanoutSettings& settings, const std::filesystem::path& folder) {
    if (std::filesystem::exists(settings.recording)) {
        return;
    }
    if (settings.recording != kDefaultRecording) {
        throw UserError("--recording " + settings.recording.string() +
                        ": there is no such file; make one with `fieldcast-server record`");
    }
    std::cout << "rendering " << settings.recording.string() << " (once; minutes without a GPU)" << std::endl;
    std::filesystem::create_directories(settings.recording.parent_path());
    const std::filesystem::path unfinished = settings.recording.string() + ".part";
    fanout::run_program(settings.server,
                        {"record", "--scene", "scenes/atelier/atelier.gltf", "--size", "640x360", "--largest-grid",
                         "3x3", "--count", std::to_string(settings.frames), "--out", unfinished},
                        folder / "record.log");
    std::filesystem::rename(unfinished, settings.recording);
}

void check(const fanout::FanoutSettings& settings) {
    if (std::set(settings.clients.begin(), settings.clients.end()).size() < 2) {
        throw UserError("--clients: give at least two numbers; the cost of a client is the slope between them");
    }
    if (!std::filesystem::exists(settings.server)) {
        throw UserError("--server " + settings.server.string() +
                        ": there is no such program; build it with ./fieldcast build");
    }
}

Json rows_of(const std::vector<fanout::Round>& rounds) {
    Json rows = Json::array();
    for (std::size_t i = 0; i < rounds.size(); ++i) {
        for (const auto& [kind, samples] :
             {std::pair("fieldcast-server", &rounds[i].served), std::pair("bare gRPC", &rounds[i].bare)}) {
            for (const fanout::Sample& sample : *samples) {
                rows.push_back({{"round", i + 1},
                                {"kind", kind},
                                {"clients", sample.clients},
                                {"cpu_ms", 1000.0 * sample.cpu_s},
                                {"megabytes", sample.megabytes},
                                {"frames", sample.frames}});
            }
        }
    }
    return rows;
}

Json json_of(const fanout::Spread& spread) {
    return {{"median", spread.median}, {"smallest", spread.smallest}, {"largest", spread.largest}};
}

Json result_of(const std::vector<fanout::Round>& rounds) {
    std::vector<double> served;
    std::vector<double> bare;
    std::vector<double> ratios;
    for (const fanout::Round& round : rounds) {
        served.push_back(marginal_ms_per_megabyte(round.served));
        bare.push_back(marginal_ms_per_megabyte(round.bare));
        ratios.push_back(round.ratio());
    }
    return {{"served_ms_per_megabyte", json_of(fanout::spread_of(served))},
            {"bare_ms_per_megabyte", json_of(fanout::spread_of(bare))},
            {"ratio", json_of(fanout::spread_of(ratios))},
            {"rows", rows_of(rounds)}};
}

void print_sums(const Json& json) {
    std::cout << "server            clients     MB/s  CPU ms/s  CPU ms per MB      (medians of all rounds)\n";
    std::map<std::pair<std::string, std::size_t>, std::array<std::vector<double>, 3>> groups;
    for (const Json& row : json["rows"]) {
        const double seconds = json["window_s"];
        const double cpu_ms = row["cpu_ms"];
        const double megabytes = row["megabytes"];
        auto& [rates, loads, costs] = groups[{row["kind"], row["clients"]}];
        rates.push_back(megabytes / seconds);
        loads.push_back(cpu_ms / seconds);
        costs.push_back(cpu_ms / megabytes);
    }
    const auto median = [](const std::vector<double>& values) { return fanout::spread_of(values).median; };
    for (const auto& [group, values] : groups) {
        std::cout << std::left << std::setw(18) << group.first << std::right << std::setw(7) << group.second
                  << std::fixed << std::setprecision(1) << std::setw(9) << median(values[0]) << std::setw(10)
                  << median(values[1]) << std::setprecision(3) << std::setw(15) << median(values[2]) << '\n';
    }
}

void print_table(const Json& json) {
    print_sums(json);
    const auto line = [&](const char* what, const char* key) {
        const Json& spread = json[key];
        std::cout << std::left << std::setw(34) << what << std::right << std::fixed << std::setprecision(3)
                  << spread["median"].get<double>() << "  (" << spread["smallest"].get<double>() << " to "
                  << spread["largest"].get<double>() << ")\n";
    };
    std::cout << "additional client, CPU ms per MB    median of rounds (least to most)\n";
    line("  fieldcast-server", "served_ms_per_megabyte");
    line("  bare gRPC", "bare_ms_per_megabyte");
    line("  ratio", "ratio");
}

/// The first columns of every line.
Json origin_of(const Json& json) {
    return {{"machine", json["processor"]},
            {"commit", json["commit"]},
            {"command", json["command"]},
            {"megabytes_per_frame", json["megabytes_per_frame"]},
            {"messages_per_frame", json["messages_per_frame"]},
            {"window_s", json["window_s"]},
            {"ratio", json["ratio"]["median"]}};
}

std::vector<fanout::Round> measure(fanout::FanoutRun& run, const fanout::FanoutSettings& settings) {
    const InterruptGuard interrupt;
    Progress progress("samples", static_cast<double>(2 * settings.clients.size() * settings.rounds));
    std::vector<fanout::Round> rounds;
    while (rounds.size() < settings.rounds) {
        rounds.push_back(run.run_round([&] {
            progress.add(1.0);
            return !interrupt.is_interrupted();
        }));
    }
    return rounds;
}

void run_fanout(const FanoutOptions& options) {
    fanout::FanoutSettings settings = options.settings;
    settings.window = std::chrono::milliseconds(static_cast<std::int64_t>(1000.0 * options.window_s));
    check(settings);
    const TemporaryFolder folder;
    settings.folder = folder.path;
    make_recording(settings, folder.path);
    fanout::FanoutRun run(settings);
    std::cout << settings.recording.string() << ": " << std::fixed << std::setprecision(2) << run.megabytes_per_frame()
              << " MB in " << std::setprecision(0) << run.messages_per_frame() << " messages per frame, "
              << std::setprecision(1) << settings.frames_per_second << " frames per second" << std::endl;
    Json json = provenance();
    json["recording"] = settings.recording.filename();
    json["megabytes_per_frame"] = run.megabytes_per_frame();
    json["messages_per_frame"] = run.messages_per_frame();
    json["frames_per_second"] = settings.frames_per_second;
    json["window_s"] = options.window_s;
    json.update(result_of(measure(run, settings)));
    print_table(json);
    if (!options.json.empty()) {
        write_json(options.json, json);
    }
    if (!options.csv.empty()) {
        write_csv(options.csv,
                  {"machine", "commit", "command", "megabytes_per_frame", "messages_per_frame", "window_s", "round",
                   "kind", "clients", "cpu_ms", "megabytes", "frames", "ratio"},
                  csv_rows(origin_of(json), json["rows"]));
    }
}

} // namespace

void add_fanout_command(CLI::App& app) {
    auto options = std::make_shared<FanoutOptions>();
    fanout::FanoutSettings& settings = options->settings;
    settings.server = server_program();
    settings.recording = kDefaultRecording;
    CLI::App* command =
        app.add_subcommand("fanout", "CPU time per additional client, against a bare gRPC stream.");
    command->add_option("--recording", settings.recording,
                        "Recording that the server replays; the default one is rendered once.")
        ->capture_default_str();
    command->add_option("--clients", settings.clients, "Numbers of simultaneous clients, at least two numbers.")
        ->delimiter(',')
        ->check(CLI::Range(1, 64))
        ->capture_default_str();
    command->add_option("--rounds", settings.rounds,
                        "Number of rounds; each measures both servers with every number of clients.")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_option("--seconds", options->window_s, "Seconds of each measurement.")
        ->check(CLI::Range(0.1, 600.0))
        ->capture_default_str();
    command->add_option("--fps", settings.frames_per_second, "Frames per second of both servers.")
        ->check(CLI::Range(0.1, 240.0))
        ->capture_default_str();
    command->add_option("--server", settings.server, "Program of the server to measure (default: that of this build).");
    command->add_option("--json", options->json, "Write the results to this JSON file.");
    command->add_option("--csv", options->csv, "Write one line per measurement to this CSV file.");
    command->footer("\nExamples:\n"
                    "  fieldcast-bench fanout\n"
                    "  fieldcast-bench fanout --clients 1,32 --rounds 3 --csv out/fanout.csv\n"
                    "  fieldcast-bench fanout --recording hall.fcrec --fps 30\n");
    command->callback([options] { run_fanout(*options); });
}

} // namespace fieldcast::bench
