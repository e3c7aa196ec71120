// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace fieldcast::bench {

// One function per subcommand of fieldcast-bench, each in a file of its own. It declares the options and sets a
// callback that runs the benchmark.

/// Rays per second of the traversal kernels against Embree.
void add_trace_command(CLI::App& app);

/// Stage breakdown of whole frames (the paper's figure 3).
void add_frame_command(CLI::App& app);

/// Savings and errors of the stages of hole filling.
void add_holes_command(CLI::App& app);

/// Bytes and times of every codec, and errors of the lossy ones.
void add_codecs_command(CLI::App& app);

/// Views made without the scene: bytes, errors, time.
void add_warp_command(CLI::App& app);

/// CPU time of the server per additional client, compared with a bare gRPC stream.
void add_fanout_command(CLI::App& app);

/// Errors of views against references (the paper's table 1).
void add_quality_command(CLI::App& app);

/// Quality and cost of grids of different sizes (the paper's figure 4).
void add_grids_command(CLI::App& app);

/// Writes the report of `quality` from the folder that it wrote.
void add_report_command(CLI::App& app);

/// The metrics of `quality` for two image files.
void add_compare_command(CLI::App& app);

/// Quality and cost of source configurations (the paper's figure 5).
void add_sources_command(CLI::App& app);

/// Renders the references of `quality` and `grids`.
void add_reference_command(CLI::App& app);

} // namespace fieldcast::bench
