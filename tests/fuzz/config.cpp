// SPDX-License-Identifier: Apache-2.0
// A --config file, for flags of each kind that the server has.
#include "server/command_line/config_file.h"

#include "core/base/error.h"
#include "core/base/toml_file.h"
#include "tests/fuzz/input.h"

#include <CLI/CLI.hpp>

namespace fieldcast::fuzz {

namespace {

struct Values {
    std::uint32_t count = 4;
    double rate = 30.0;
    std::string listen = "127.0.0.1:50151";
    std::vector<std::string> scenes;
    bool has_validation = false;
};

void add_flags(CLI::App& app, Values& values) {
    app.add_option("--spp", values.count, "count")->capture_default_str();
    app.add_option("--fps", values.rate, "rate")->capture_default_str();
    app.add_option("--listen", values.listen, "address")->capture_default_str();
    app.add_option("--scene", values.scenes, "scenes");
    app.add_flag("--validation", values.has_validation, "switch");
    app.add_option("--config", "this file")->configurable(false);
}

/// As the server does it; bad values are a problem for CLI11 to report.
void parse(const std::vector<std::string>& arguments) {
    CLI::App app;
    Values values;
    add_flags(app, values);
    try {
        app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    } catch (const CLI::Error&) {
        return;
    }
    const std::string text = command_line::config_text(app);
    const auto file = scratch_file("again.toml", std::as_bytes(std::span(text)));
    CLI::App other;
    Values unset;
    add_flags(other, unset);
    FC_ASSERT(command_line::read_config_file(file, other).problems.empty(), "what --print-config writes can be read");
}

} // namespace

void config(Bytes input) {
    const auto file = scratch_file("config.toml", input);
    CLI::App app;
    Values values;
    add_flags(app, values);
    const command_line::FileArguments read = command_line::read_config_file(file, app);
    for (const std::string& problem : read.problems) {
        FC_ASSERT(problem.starts_with(file.string()), "a problem names its file");
    }
    parse(read.arguments);
    static_cast<void>(read_toml_tree(file));
}

} // namespace fieldcast::fuzz
