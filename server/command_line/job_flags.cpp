// SPDX-License-Identifier: Apache-2.0
#include "server/command_line/job_flags.h"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace fieldcast::command_line {

void add_offline_flags(CLI::App& app, channel::OfflineJob& job, std::vector<std::string>& products) {
    const auto add = [&](CLI::Option* option) { option->group("render")->configurable(false); };
    add(app.add_option("--out", job.out, "Folder that gets the files.")->capture_default_str());
    add(app.add_option("--count", job.frame_count, "Frames to render, 1/fps apart, from a cold start.")
            ->check(CLI::Range(1U, 1U << 24U))
            ->capture_default_str());
    add(app.add_flag("--every-frame", job.writes_every_frame,
                     "Write every frame to a folder of its own instead of the last frame only."));
    add(app.add_option("--reference", job.reference_samples,
                       "Samples per pixel with which every view of the last frame is also path traced without reuse, "
                       "into an EXR each.")
            ->check(CLI::Range(1U, 1U << 20U)));
    add(app.add_option("--write", products, "quilt, views, contact-sheet, look-around, exr (the source's planes).")
            ->delimiter(',')
            ->check(CLI::IsMember({"quilt", "views", "contact-sheet", "look-around", "exr"}))
            ->capture_default_str());
}

void add_record_flags(CLI::App& app, channel::RecordJob& job) {
    const auto add = [&](CLI::Option* option) { option->group("record")->configurable(false); };
    add(app.add_option("--out", job.out, "File of the recording.")->capture_default_str());
    add(app.add_option("--count", job.frame_count, "Frames to record, 1/fps apart, from a cold start.")
            ->check(CLI::Range(1U, 1U << 24U))
            ->capture_default_str());
}

image::LightFieldProducts read_products(const std::vector<std::string>& words) {
    const auto has = [&](const char* word) { return std::ranges::find(words, word) != words.end(); };
    return {.quilt = has("quilt"),
            .views = has("views"),
            .contact_sheet = has("contact-sheet"),
            .look_around = has("look-around"),
            .source_exr = has("exr")};
}

} // namespace fieldcast::command_line
