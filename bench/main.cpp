// SPDX-License-Identifier: Apache-2.0
// fieldcast-bench: one subcommand per benchmark.
#include "bench/commands.h"
#include "bench/interrupt.h"
#include "core/base/error.h"

#include <iostream>

namespace {

constexpr int kUserError = 2;
constexpr int kMachineFailed = 1;

int start(int argc, char** argv) {
    CLI::App app{"Benchmarks of Fieldcast", "fieldcast-bench"};
    app.require_subcommand(1);
    fieldcast::bench::add_trace_command(app);
    fieldcast::bench::add_frame_command(app);
    fieldcast::bench::add_holes_command(app);
    fieldcast::bench::add_codecs_command(app);
    fieldcast::bench::add_warp_command(app);
    fieldcast::bench::add_fanout_command(app);
    fieldcast::bench::add_quality_command(app);
    fieldcast::bench::add_grids_command(app);
    fieldcast::bench::add_sources_command(app);
    fieldcast::bench::add_reference_command(app);
    fieldcast::bench::add_report_command(app);
    fieldcast::bench::add_compare_command(app);
    app.footer(
        "\n`./fieldcast bench flip FOLDER` adds FLIP to the results of `quality --out FOLDER`.\n"
        "docs/measurements/metrics.md explains all numbers.");
    CLI11_PARSE(app, argc, argv);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    try {
        return start(argc, argv);
    } catch (const fieldcast::bench::Interrupted& interrupted) {
        std::cerr << "\ninterrupted: " << interrupted.what_is_left << '\n';
        return fieldcast::bench::kInterrupted;
    } catch (const fieldcast::UserError& error) {
        std::cerr << "fieldcast-bench: " << error.what() << '\n';
        return kUserError;
    } catch (const std::exception& error) {
        std::cerr << "fieldcast-bench: " << error.what() << '\n';
        return kMachineFailed;
    }
}
