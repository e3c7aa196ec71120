// SPDX-License-Identifier: Apache-2.0
#include "server/ops/recording_flags.h"

#include "core/lightfield/frame_rate.h"
#include "server/ops/config.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>

namespace fieldcast::ops {

namespace {

constexpr std::size_t kMaxForms = 64;

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

void check_replays(const Config& config, std::vector<std::string>& problems) {
    for (const recording::ReplaySetup& replay : config.replays) {
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(replay.file, ignored)) {
            problems.push_back("--replay " + replay.file.string() + ": there is no such file");
        }
        if (replay.name.size() > feed::kMaxChannelNameBytes) {
            problems.push_back("--replay " + replay.name + ": a name has 1 to 64 bytes");
        }
        const float fps = replay.frames_per_second.value_or(1.0F);
        if (!is_frame_rate(fps)) {
            problems.push_back("--replay-fps " + std::to_string(fps) + ": 0.1 to 240");
            break;
        }
    }
}

void check_records(const Config& config, std::vector<std::string>& problems) {
    std::set<std::string> channels;
    for (const RecordChoice& record : config.records) {
        const bool is_known = record.channel.empty()
                                  ? config.channels.size() == 1
                                  : std::ranges::find(config.channels, record.channel, &ChannelChoice::name) !=
                                        config.channels.end();
        if (!is_known) {
            problems.push_back("--record " + record.file.string() +
                               (record.channel.empty() ? ": with several channels or none, write NAME=FILE"
                                                       : ": there is no scene's channel '" + record.channel + "'"));
        }
        const auto recorded = std::ranges::find_if(config.channels, [&](const ChannelChoice& channel) {
            return record.channel.empty() || channel.name == record.channel;
        });
        if (is_known && recorded->control == feed::CameraControl::kOwn) {
            problems.push_back("--record " + record.file.string() +
                               ": with --camera-control own every client of channel '" + recorded->name +
                               "' sees something else; record a channel with another camera control");
        }
        if (!channels.insert(record.channel).second) {
            problems.push_back("--record " + record.file.string() + ": this channel is recorded already");
        }
    }
}

} // namespace

void add_recording_flags(CLI::App& app, RecordingText& text, Config& config) {
    app.add_option("--replay", text.replays,
                   "FILE or NAME=FILE: a recording as a channel, in a loop; needs no device. May be repeated")
        ->group("Recordings");
    app.add_option("--replay-fps", config.replay_fps, "Frames per second of replays, 0.1 to 240; default: as recorded")
        ->group("Recordings");
    app.add_option("--record", text.records,
                   "FILE or CHANNEL=FILE: records that channel while serving. May be repeated")
        ->group("Recordings");
    app.add_option(
           "--record-form", text.forms,
           "What to record; default: views. May be repeated. To type: " + recording::form_syntax())
        ->group("Recordings");
    app.add_option("--record-frames", config.record_frames, "Ends each recording after so many frames; 0: never")
        ->group("Recordings")
        ->capture_default_str();
}

void read_recordings(const RecordingText& text, Config& config, std::vector<std::string>& problems) {
    for (const std::string& record : text.records) {
        NamedFile named = read_named_file(record);
        config.records.push_back({.channel = std::move(named.name), .file = std::move(named.file)});
    }
    for (const std::string& replay : text.replays) {
        NamedFile named = read_named_file(replay);
        config.replays.push_back({.file = std::move(named.file),
                                  .name = std::move(named.name),
                                  .frames_per_second = config.replay_fps});
    }
    for (const std::string& typed : text.forms) {
        const auto form = recording::parse_form(typed);
        const auto problem = form && form->grid ? grid_problem(*form->grid) : std::nullopt;
        if (form && !problem) {
            config.record_forms.push_back(*form);
        } else {
            problems.push_back("--record-form " + typed + ": " + problem.value_or(recording::form_syntax()));
        }
    }
    if (config.record_forms.empty()) {
        config.record_forms.emplace_back(); // views of the largest grid
    }
}

std::vector<std::string> recording_problems(const Config& config) {
    std::vector<std::string> problems;
    check_replays(config, problems);
    check_records(config, problems);
    for (const recording::RecordedForm& form : config.record_forms) {
        const glm::uvec2 size = form.size_px.value_or(glm::uvec2(1));
        if (size.x == 0 || size.y == 0 || size.x > config.width_px || size.y > config.height_px) {
            problems.push_back("--record-form " + std::to_string(size.x) + "x" + std::to_string(size.y) +
                               ": a view has at least 1 pixel on each side and at most as many as the source, see --size");
        }
    }
    if (config.record_forms.size() > kMaxForms) {
        problems.emplace_back("--record-form: at most 64");
    }
    return problems;
}

} // namespace fieldcast::ops
