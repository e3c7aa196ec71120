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
  Twenty viewers of nine views each, half a minute:
    fieldcast-load --clients 20 --grid 3x3 --duration 30 127.0.0.1:50151
  What a scenario file describes, with a page to mail and the numbers for a plotter:
    fieldcast-load --scenario bench/load/mixed.toml --html load.html --hgrm load 127.0.0.1:50151
  In a pipeline: fails if the 99th percentile is above 300 ms or any client gets less than two frames per second:
    fieldcast-load --clients 50 --ramp 10 --require due_p99_ms=300 --require least_fps=2 --json load.json HOST:PORT
  Clients that cannot keep up, and what the server says about them:
    fieldcast-load --clients 4 --reads-kbit-per-second 500 --metrics http://127.0.0.1:9464/metrics 127.0.0.1:50151

Latency "due": from a moment on a fixed schedule, at which a viewer wants to see the world as it is then, to the first
frame that shows it; a stall counts for every moment that it covers.

Exit codes: 0 everything holds, 1 the run failed or nobody got a frame, 2 what was asked cannot be had, 3 a threshold
was missed. After Ctrl-C the run ends early, with a report; the second Ctrl-C ends it at once (130).
)";

/// Flags that are settings of a scenario file, as they were typed.
struct FlagText {
    std::string address;
    std::string scenario;
    std::vector<std::pair<std::string, std::string>> group;  ///< key and value
    std::vector<std::pair<std::string, std::string>> common; ///< of the scenario
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
    const char* const group = "Clients, without --scenario";
    add_setting(app, "--clients", "count", "How many (default 1)", to)->group(group);
    add_setting(app, "--mode", "mode", alternatives<DeliveryMode>() + " (default views)", to)->group(group);
    add_setting(app, "--grid", "grid", "Views, ROWSxCOLS (default 4x4)", to)->group(group);
    add_setting(app, "--size", "size", "Pixels of a view, WIDTHxHEIGHT; without it: those of the source", to)
        ->group(group);
    add_setting(app, "--planes", "planes", "Of mode scene: " + alternatives<PlaneSet>() + " (default g-buffer)", to)
        ->group(group);
    add_setting(app, "--codec", "codec",
                alternatives<Codec>() + "; several with +, most wanted first (default zstd)", to)
        ->group(group);
    add_setting(app, "--quality", "quality", "Of lossy codecs, 1 to 100; without it: the server's choice", to)
        ->group(group);
    add_setting(app, "--channel", "channel", "Name of the channel; without it: the server's first", to)->group(group);
    add_setting(app, "--decoding", "decoding", "full, checksum or headers (default checksum)", to)->group(group);
    add_setting(app, "--max-fps", "max-fps", "Frames per second that a client asks for at most", to)->group(group);
    add_setting(app, "--due-fps", "due-fps", "Rate of due moments; without it: what the server means to send", to)
        ->group(group);
    add_setting(app, "--reads-kbit-per-second", "reads-kbit-per-second", "Slow readers: how fast they read", to)
        ->group(group);
    add_setting(app, "--think", "think", "Seconds without reading after each frame", to)->group(group);
    add_setting(app, "--stay", "stay", "Churn: leave after about so many seconds", to)->group(group);
    add_setting(app, "--away", "away", "Churn: come back after about so many seconds (default 1)", to)->group(group);
}

void add_run_flags(CLI::App& app, FlagText& text) {
    Settings& to = text.common;
    app.add_option("address", text.address, "HOST:PORT or https://HOST:PORT (default 127.0.0.1:50151)");
    app.add_option("--scenario", text.scenario, "TOML file with groups of clients, see docs/load.md");
    add_setting(app, "--duration", "duration", "Seconds that are measured; 0: until Ctrl-C (default 30)", to);
    add_setting(app, "--ramp", "ramp", "Seconds over which clients start; not measured (default 0)", to);
    add_setting(app, "--threads", "threads", "Threads that decode; 0: one per hardware thread", to);
    add_setting(app, "--seed", "seed", "Of everything random (default 1)", to);
    add_setting(app, "--metrics", "metrics", "http://127.0.0.1:PORT/metrics of the server, to report beside", to);
    app.add_option("--require", text.required,
                   "NAME=LIMIT that every group must keep; repeatable: " + load::threshold_names())
        ->allow_extra_args(false);
}

void add_access_flags(CLI::App& app, FlagText& text) {
    Settings& to = text.target;
    const char* const access = "Access";
    app.add_flag_callback(
           "--tls", [&to] { to.emplace_back("tls", "true"); }, "Encrypt; also by https://HOST:PORT")
        ->group(access);
    add_setting(app, "--tls-ca", "tls-ca", "PEM file: who may have signed the server's certificate", to)->group(access);
    add_setting(app, "--tls-cert", "tls-cert", "PEM file: our certificate, for servers that ask for one", to)
        ->group(access);
    add_setting(app, "--tls-key", "tls-key", "PEM file: its private key", to)->group(access);
    add_setting(app, "--tls-name", "tls-name", "Name in the server's certificate, if not the dialled one", to)
        ->group(access);
    add_setting(app, "--token-file", "token-file", "File with the token; without it: FIELDCAST_TOKEN", to)
        ->group(access);
}

void add_output_flags(CLI::App& app, LoadOptions& options) {
    app.add_option("--json", options.json, "Write all results to this file");
    app.add_option("--html", options.html, "Write a self-contained page with plots to this file");
    app.add_option("--hgrm", options.hgrm, "Write latency distributions to this folder, GROUP.STAGE.hgrm");
    app.add_flag("--check", options.is_check, "Only validate flags and scenario");
    app.add_flag("--quiet", options.is_quiet, "No live view");
    app.add_flag("--verbose", options.is_verbose, "Log what the transport says");
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
                        ": the groups of --scenario say that");
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
    if (const char* const token = std::getenv("FIELDCAST_TOKEN")) { // no flag: other users see a process' arguments
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
    CLI::App app("Drives a fieldcast-server with many clients and tells what they got.", "fieldcast-load");
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
