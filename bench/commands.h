// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace fieldcast::bench {

// One function per subcommand of fieldcast-bench, each in a file of its own: declares the options, and the callback
// runs the benchmark when the command is chosen.

/// Rays per second of the traversal kernels against Embree.
void add_trace_command(CLI::App& app);

/// Stage breakdown of whole frames (the paper's figure 3).
void add_frame_command(CLI::App& app);

/// What the stages of hole filling save and cost.
void add_holes_command(CLI::App& app);

/// Bytes and times of every codec, and what lossy ones take away.
void add_codecs_command(CLI::App& app);

/// Views made without the scene: bytes, errors, time.
void add_warp_command(CLI::App& app);

/// What one more client costs the server, against a bare gRPC stream.
void add_fanout_command(CLI::App& app);

/// Errors of views against references (the paper's table 1).
void add_quality_command(CLI::App& app);

/// Quality and cost of grids of different sizes (the paper's figure 4).
void add_grids_command(CLI::App& app);

/// The report of `quality` from what it wrote into a folder.
void add_report_command(CLI::App& app);

/// The metrics of `quality` for two image files.
void add_compare_command(CLI::App& app);

/// Quality and cost of source configurations (the paper's figure 5).
void add_sources_command(CLI::App& app);

/// The references of `quality` and `grids`.
void add_reference_command(CLI::App& app);

} // namespace fieldcast::bench
