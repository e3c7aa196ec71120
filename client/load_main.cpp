// SPDX-License-Identifier: Apache-2.0
#include "client/interrupt.h"
#include "client/load/load_run.h"
#include "client/load/result_files.h"
#include "client/load_console.h"
#include "client/load_options.h"

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/base/printable.h"

#include <cstdio>

namespace {

using namespace fieldcast;

constexpr int kExitMissed = 3;

int report(const client::LoadOptions& options, const client::load::LoadResult& result) {
    std::fputs(to_table(result).c_str(), stdout);
    if (!options.json.empty()) {
        client::load::write_json(result, options.json);
    }
    if (!options.html.empty()) {
        client::load::write_html(result, options.html);
    }
    if (!options.hgrm.empty()) {
        client::load::write_hgrm(result, options.hgrm);
    }
    if (!result.has_frames()) {
        std::fputs("fieldcast-load: no client received a frame\n", stderr);
        return client::kExitFailed;
    }
    return result.holds() ? 0 : kExitMissed;
}

int run(const client::LoadOptions& options) {
    log::set_level(options.is_verbose ? log::Level::kDebug : log::Level::kWarn);
    const client::Interrupt interrupt;
    client::LoadConsole console;
    const auto on_progress = [&](const client::load::LoadProgress& progress) {
        if (!options.is_quiet) {
            console.show(progress);
        }
    };
    try {
        return report(options, client::load::run_load(options.scenario, on_progress, interrupt.token()));
    } catch (const UserError& error) {
        std::fprintf(stderr, "fieldcast-load: %s\n", printable(error.what()).c_str());
        return client::kExitUserError;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "fieldcast-load: %s\n", printable(error.what()).c_str());
        return client::kExitFailed;
    }
}

} // namespace

int main(int argc, char** argv) {
    const client::LoadInvocation invocation = client::read_load_options(argc, argv);
    if (!invocation.options) {
        std::fputs(invocation.text.c_str(), invocation.exit_code == 0 ? stdout : stderr);
        return invocation.exit_code;
    }
    if (invocation.options->is_check) {
        std::puts("the scenario is valid");
        return 0;
    }
    return run(*invocation.options);
}
