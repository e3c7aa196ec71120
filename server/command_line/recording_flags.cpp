// SPDX-License-Identifier: Apache-2.0
#include "server/command_line/recording_flags.h"

#include <CLI/CLI.hpp>

namespace fieldcast::command_line {

namespace {

struct NamedFile {
    std::string name; ///< empty: not given
    std::filesystem::path file;
};

/// Reads FILE or NAME=FILE; a file whose own name has a "=" is taken as it stands if it is there.
NamedFile read_named_file(const std::string& text) {
    const std::size_t equals = text.find('=');
    std::error_code ignored;
    if (equals == std::string::npos || std::filesystem::exists(text, ignored)) {
        return {.name = "", .file = text};
    }
    return {.name = text.substr(0, equals), .file = text.substr(equals + 1)};
}

} // namespace

void add_recording_flags(CLI::App& app, RecordingText& text, channel::Settings& rendering) {
    const auto add = [&](const char* flag, auto& value, const std::string& help) {
        return app.add_option(flag, value, help)->group("Recordings");
    };
    add("--replay", text.replays,
        "FILE or NAME=FILE: show a recording in a loop as a channel, without a device. Repeatable.");
    add("--replay-fps", text.replay_fps, "Frames per second of replays, 0.1 to 240; default: as recorded.");
    add("--record", text.records, "FILE or CHANNEL=FILE: record this channel while serving. Repeatable.");
    add("--record-form", text.forms,
        "What a recording contains; default: views. Repeatable; " + recording::form_syntax() + ".");
    add("--record-frames", rendering.record_frames, "Number of frames after which each recording ends; 0: never.")
        ->capture_default_str();
}

void read_recordings(const RecordingText& text, channel::Settings& rendering, std::vector<std::string>& problems) {
    for (const std::string& record : text.records) {
        NamedFile named = read_named_file(record);
        rendering.records.push_back({.channel = std::move(named.name), .file = std::move(named.file)});
    }
    for (const std::string& replay : text.replays) {
        NamedFile named = read_named_file(replay);
        rendering.replays.push_back(
            {.file = std::move(named.file), .name = std::move(named.name), .frames_per_second = text.replay_fps});
    }
    for (const std::string& typed : text.forms) {
        const auto form = recording::parse_form(typed);
        const auto problem = form && form->grid ? grid_problem(*form->grid) : std::nullopt;
        if (form && !problem) {
            rendering.record_forms.push_back(*form);
        } else {
            problems.push_back("--record-form " + typed + ": " + problem.value_or(recording::form_syntax()));
        }
    }
    if (rendering.record_forms.empty()) {
        rendering.record_forms.emplace_back(); // views of the largest grid
    }
}

} // namespace fieldcast::command_line
