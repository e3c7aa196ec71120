// SPDX-License-Identifier: Apache-2.0
#include "server/config/recording_problems.h"

#include "core/lightfield/frame_rate.h"

#include <algorithm>
#include <set>
#include <system_error>

namespace fieldcast::config {

namespace {

constexpr std::size_t kMaxForms = 64;

void check_replays(const channel::Settings& rendering, std::vector<std::string>& problems) {
    for (const recording::ReplaySetup& replay : rendering.replays) {
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

void check_records(const channel::Settings& rendering, std::vector<std::string>& problems) {
    std::set<std::string> channels;
    for (const channel::RecordChoice& record : rendering.records) {
        const bool is_known = record.channel.empty()
                                  ? rendering.channels.size() == 1
                                  : std::ranges::find(rendering.channels, record.channel,
                                                      &channel::ChannelChoice::name) != rendering.channels.end();
        if (!is_known) {
            problems.push_back("--record " + record.file.string() +
                               (record.channel.empty() ? ": with several channels or none, write NAME=FILE"
                                                       : ": there is no scene's channel '" + record.channel + "'"));
        }
        const auto recorded = std::ranges::find_if(rendering.channels, [&](const channel::ChannelChoice& channel) {
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

std::vector<std::string> recording_problems(const channel::Settings& rendering) {
    std::vector<std::string> problems;
    check_replays(rendering, problems);
    check_records(rendering, problems);
    for (const recording::RecordedForm& form : rendering.record_forms) {
        const glm::uvec2 size = form.size_px.value_or(glm::uvec2(1));
        if (size.x == 0 || size.y == 0 || size.x > rendering.width_px || size.y > rendering.height_px) {
            problems.push_back(
                "--record-form " + std::to_string(size.x) + "x" + std::to_string(size.y) +
                ": a view has at least 1 pixel on each side and at most as many as the source, see --size");
        }
    }
    if (rendering.record_forms.size() > kMaxForms) {
        problems.emplace_back("--record-form: at most 64");
    }
    return problems;
}

} // namespace fieldcast::config
