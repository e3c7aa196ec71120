// SPDX-License-Identifier: Apache-2.0
#include "client/load_options.h"
#include "client/flag_report.h"

#include "core/base/error.h"

#include <CLI/CLI.hpp>
#include <cstdlib>

namespace fieldcast::client {
namespace {

constexpr const char* kExamples = R"(
Examples:
  Twenty viewers of nine views each, for half a minute:
    fieldcast-load --clients 20 --grid 3x3 --duration 30 127.0.0.1:50151
  The clients of a scenario file, with an HTML report and latency distributions for plotters:
    fieldcast-load --scenario bench/load/mixed.toml --html load.html --hgrm load 127.0.0.1:50151
  A CI job that fails if the 99th percentile exceeds 300 ms or any client gets fewer than two frames per second:
    fieldcast-load --clients 50 --ramp 10 --require due_p99_ms=300 --require least_fps=2 --json load.json HOST:PORT
  Clients that read too slowly, with the server's metrics in the result:
    fieldcast-load --clients 4 --reads-kbit-per-second 500 --metrics http://127.0.0.1:9464/metrics 127.0.0.1:50151

Latency "due": time from a moment of a fixed schedule to the first frame that shows the scene at that moment or later.
A stall counts once for every moment of the schedule that it covers.

Exit codes: 0 all thresholds hold, 1 the run failed or no client received a frame, 2 the flags, the scenario or the
request are not valid, 3 a threshold was missed. The first Ctrl-C ends the run early, with a report; the second one ends
it at once (130).
)";

/// The command line before it is checked; most flags are settings of a scenario file.
struct FlagText {
    std::string address;
    std::string scenario;
    std::vector<std::pair<std::string, std::string>> group;  ///< key and value
    std::vector<std::pair<std::string, std::string>> common; ///< settings of the scenario
    std::vector<std::pair<std::string, std::string>> target;
    std::vector<std::string> required;
};

using Settings = std::vector<std::pair<std::string, std::string>>;

CLI::Option* add_setting(CLI::App& app, const std::string& flag, const std::string& key, const std::string& help,
                         Settings& settings) {
    const auto note = [&settings, key](const std::string& value) { settings.emplace_back(key, value); };
    return app.add_option_function<std::string>(flag, note, help);
}

void add_group_flags(CLI::App& app, FlagText& text) {
    Settings& to = text.group;
    const char* const group = "Clients (without --scenario)";
    add_setting(app, "--clients", "count", "Number of clients (default 1).", to)->group(group);
    add_setting(app, "--mode", "mode", "Delivery mode: " + alternatives<DeliveryMode>() + " (default views).", to)
        ->group(group);
    add_setting(app, "--grid", "grid", "Grid of views, ROWSxCOLS (default 4x4).", to)->group(group);
    add_setting(app, "--size", "size", "Size of one view in pixels, WIDTHxHEIGHT (default: that of the source).", to)
        ->group(group);
    add_setting(app, "--planes", "planes",
                "Mode scene: source planes to receive, " + alternatives<PlaneSet>() + " (default g-buffer).", to)
        ->group(group);
    add_setting(app, "--codec", "codec",
                "Codecs, most wanted first, joined with +: " + alternatives<Codec>() + " (default zstd).", to)
        ->group(group);
    add_setting(app, "--quality", "quality", "Quality of lossy codecs, 1 to 100 (default: the server's choice).", to)
        ->group(group);
    add_setting(app, "--channel", "channel", "Name of the channel (default: the server's first).", to)->group(group);
    add_setting(app, "--decoding", "decoding", "Work per frame: full, checksum or headers (default checksum).", to)
        ->group(group);
    add_setting(app, "--max-fps", "max-fps",
                "Largest frame rate that a client requests, frames per second (default: the channel's).", to)
        ->group(group);
    add_setting(app, "--due-fps", "due-fps",
                "Due moments per second (default: the frame rate that the server announces).", to)
        ->group(group);
    add_setting(app, "--reads-kbit-per-second", "reads-kbit-per-second",
                "Slow readers: rate at which a client reads, kbit/s.", to)
        ->group(group);
    add_setting(app, "--think", "think", "Seconds without reading after each frame (default 0).", to)->group(group);
    add_setting(app, "--stay", "stay", "Churn: mean seconds until a client leaves (default: it stays).", to)
        ->group(group);
    add_setting(app, "--away", "away", "Churn: mean seconds until a client returns (default 1).", to)->group(group);
}

void add_run_flags(CLI::App& app, FlagText& text) {
    Settings& to = text.common;
    app.add_option("address", text.address, "Server: HOST:PORT or https://HOST:PORT (default 127.0.0.1:50151).");
    app.add_option("--scenario", text.scenario, "TOML file with groups of clients, see docs/load.md.");
    add_setting(app, "--duration", "duration", "Seconds of measurement after the ramp; 0: until Ctrl-C (default 30).",
                to);
    add_setting(app, "--ramp", "ramp", "Seconds over which the clients start, not measured (default 0).", to);
    add_setting(app, "--threads", "threads", "Decoder threads, at most 256; 0: one per hardware thread (default 0).",
                to);
    add_setting(app, "--seed", "seed", "Seed of all random numbers (default 1).", to);
    add_setting(app, "--metrics", "metrics",
                "Metrics page of the server to include in the result, http://127.0.0.1:PORT/metrics.", to);
    app.add_option("--require", text.required,
                   "NAME=LIMIT: threshold for every group. May be repeated. Names: " + load::threshold_names())
        ->allow_extra_args(false);
}

void add_access_flags(CLI::App& app, FlagText& text) {
    Settings& to = text.target;
    const char* const access = "Access";
    app.add_flag_callback(
           "--tls", [&to] { to.emplace_back("tls", "true"); }, "Encrypt the connection, as https://HOST:PORT does.")
        ->group(access);
    add_setting(app, "--tls-ca", "tls-ca",
                "PEM file of authorities for the server's certificate (default: the system's).", to)
        ->group(access);
    add_setting(app, "--tls-cert", "tls-cert", "PEM file of the client certificate, if the server requires one.", to)
        ->group(access);
    add_setting(app, "--tls-key", "tls-key", "PEM file of the private key for --tls-cert.", to)->group(access);
    add_setting(app, "--tls-name", "tls-name", "Name in the server's certificate (default: the host of the address).",
                to)
        ->group(access);
    add_setting(app, "--token-file", "token-file", "File with the token (default: the variable FIELDCAST_TOKEN).", to)
        ->group(access);
}

void add_output_flags(CLI::App& app, LoadOptions& options) {
    app.add_option("--json", options.json, "Write all results to this JSON file.");
    app.add_option("--html", options.html, "Write a self-contained report with plots to this HTML file.");
    app.add_option("--hgrm", options.hgrm, "Write latency distributions to this folder, as GROUP.STAGE.hgrm.");
    app.add_flag("--check", options.is_check, "Validate flags and scenario, then exit.");
    app.add_flag("--quiet", options.is_quiet, "Print no progress.");
    app.add_flag("--verbose", options.is_verbose, "Log at level debug, messages of the transport included.");
}

template <class Set> void apply(const Settings& settings, Set set) {
    for (const auto& [key, value] : settings) {
        if (const std::string problem = set(key, value); !problem.empty()) {
            throw UserError("--" + (key == "count" ? "clients" : key) + " " + value + ": " + problem);
        }
    }
}

load::Scenario scenario_of(const FlagText& text) {
    if (!text.scenario.empty() && !text.group.empty()) {
        throw UserError("--" + (text.group.front().first == "count" ? "clients" : text.group.front().first) +
                        ": not allowed with --scenario, whose groups define it");
    }
    if (!text.scenario.empty()) {
        return load::read_scenario(text.scenario);
    }
    load::Scenario scenario;
    load::Group group;
    group.name = "clients";
    apply(text.group, [&](const auto& key, const auto& value) { return load::set_in_group(key, value, group); });
    scenario.groups.push_back(std::move(group));
    return scenario;
}

void read_required(const std::vector<std::string>& required, load::Scenario& scenario) {
    for (const std::string& text : required) {
        const std::size_t cut = text.find('=');
        const std::string limit = cut == std::string::npos ? "" : text.substr(cut + 1);
        const std::string problem = load::add_threshold(text.substr(0, cut), limit, scenario.thresholds);
        if (!problem.empty()) {
            throw UserError("--require " + text + ": " + problem);
        }
    }
}

load::Scenario read_text(const FlagText& text) {
    load::Scenario scenario = scenario_of(text);
    apply(text.common, [&](const auto& key, const auto& value) { return load::set_in_scenario(key, value, scenario); });
    apply(text.target, [&](const auto& key, const auto& value) { return load::set_in_target(key, value, scenario); });
    read_required(text.required, scenario);
    if (!text.address.empty()) {
        scenario.address = net::without_scheme(text.address, scenario.access);
    }
    if (const char* const token = std::getenv("FIELDCAST_TOKEN")) { // no flag: any user can read process arguments
        scenario.access.token = token;
    }
    std::string problems;
    for (const std::string& problem : load::problems_of(scenario)) {
        problems += (problems.empty() ? "" : "\n") + problem;
    }
    if (!problems.empty()) {
        throw UserError(problems);
    }
    return scenario;
}

} // namespace

LoadInvocation read_load_options(int argc, const char* const* argv) {
    CLI::App app("Runs many clients against a fieldcast-server and measures the frames that they receive.",
                 "fieldcast-load");
    app.footer(kExamples);
    FlagText text;
    LoadOptions options;
    add_run_flags(app, text);
    add_output_flags(app, options);
    add_group_flags(app, text);
    add_access_flags(app, text);
    try {
        app.parse(argc, argv);
        options.scenario = read_text(text);
        return {options, "", 0};
    } catch (const CLI::ParseError& error) {
        const FlagReport report = report_of(app, error);
        return {std::nullopt, report.text, report.exit_code};
    } catch (const UserError& error) {
        return {std::nullopt, std::string(error.what()) + "\n", 2};
    }
}

} // namespace fieldcast::client
