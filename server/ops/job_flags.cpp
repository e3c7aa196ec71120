// SPDX-License-Identifier: Apache-2.0
#include "server/ops/job_flags.h"

#include <CLI/CLI.hpp>

namespace fieldcast::ops {

void add_offline_flags(CLI::App& app, OfflineJob& job, std::vector<std::string>& products) {
    const auto add = [&](CLI::Option* option) { option->group("render")->configurable(false); };
    add(app.add_option("--out", job.out, "Folder for the files")->capture_default_str());
    add(app.add_option("--count", job.frame_count, "Frames to render, 1/fps apart, from a cold start")
            ->check(CLI::Range(1U, 1U << 24U))
            ->capture_default_str());
    add(app.add_flag("--every-frame", job.writes_every_frame, "Write all frames, each to a folder; else the last"));
    add(app.add_option("--reference", job.reference_samples,
                       "Path trace every view of the last frame with so many samples, reuse nothing; also an EXR each")
            ->check(CLI::Range(1U, 1U << 20U)));
    add(app.add_option("--write", products, "quilt, views, contact-sheet, look-around, exr (the source's planes)")
            ->delimiter(',')
            ->check(CLI::IsMember({"quilt", "views", "contact-sheet", "look-around", "exr"}))
            ->capture_default_str());
}

void add_record_flags(CLI::App& app, RecordJob& job) {
    const auto add = [&](CLI::Option* option) { option->group("record")->configurable(false); };
    add(app.add_option("--out", job.out, "The recording")->capture_default_str());
    add(app.add_option("--count", job.frame_count, "Frames to record, 1/fps apart, from a cold start")
            ->check(CLI::Range(1U, 1U << 24U))
            ->capture_default_str());
}

} // namespace fieldcast::ops
