// SPDX-License-Identifier: Apache-2.0
#include "server/command_line/serving_flags.h"

#include "server/command_line/word_flags.h"

#include <array>

namespace fieldcast::command_line {

namespace {

constexpr const char* kGroup = "Serving";

constexpr std::array kLevels{
    Word{.word = "debug", .value = log::Level::kDebug}, Word{.word = "info", .value = log::Level::kInfo},
    Word{.word = "warn", .value = log::Level::kWarn}, Word{.word = "error", .value = log::Level::kError}};
constexpr std::array kFormats{Word{.word = "text", .value = log::Format::kText},
                              Word{.word = "json", .value = log::Format::kJson}};

} // namespace

void add_serving_flags(CLI::App& app, WordFlags& words, ServingText& text, config::Config& config) {
    const auto add = [&](const char* flag, auto& value, const char* help) {
        return app.add_option(flag, value, help)->group(kGroup);
    };
    add("--listen", text.listen,
        "HOST:PORT; beyond loopback only with TLS, tokens and gRPC 1.57; port 0: any free port, with --port-file.")
        ->capture_default_str();
    add("--port-file", text.port_file, "File that gets the port number once the server is SERVING.");
    add("--quality", config.rendering.lossy_quality,
        "Quality of planes in a lossy codec, 1 to 100, for clients that choose none.")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    add("--metrics-listen", text.metrics_listen,
        "HOST:PORT of /metrics for Prometheus; beyond loopback only with TLS and tokens.");
    add("--metrics-port-file", text.metrics_port_file, "File that gets the port number of /metrics.");
    add("--frame-log", text.frame_log, "FILE.csv or FILE.jsonl: one row per frame and client, from pose to display.");
    add("--trace", text.trace, "FILE.json for ui.perfetto.dev: every frame of every channel and client.");
    words.add("--log-format", config.log_format, kFormats, "Form of the log: text, or json (one object per line).")
        ->group(kGroup);
    words.add("--log-level", config.log_level, kLevels, "Least level that is logged: debug, info, warn or error.")
        ->group(kGroup);
}

void read_serving(const ServingText& text, config::Config& config, std::vector<std::string>& problems) {
    if (const auto address = parse_host_port(text.listen)) {
        config.listen = *address;
    } else {
        problems.push_back("--listen " + text.listen + ": write HOST:PORT, as in 127.0.0.1:50151 or [::1]:50151");
    }
    config.metrics_listen = parse_host_port(text.metrics_listen);
    if (!config.metrics_listen && !text.metrics_listen.empty()) {
        problems.push_back("--metrics-listen " + text.metrics_listen + ": write HOST:PORT, as in 127.0.0.1:9464");
    }
    if (!text.metrics_port_file.empty()) {
        config.metrics_port_file = text.metrics_port_file;
    }
    if (!text.port_file.empty()) {
        config.port_file = text.port_file;
    }
    config.timing_files = {.frame_log = text.frame_log, .trace = text.trace};
}

} // namespace fieldcast::command_line
