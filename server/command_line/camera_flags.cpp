// SPDX-License-Identifier: Apache-2.0
#include "server/command_line/camera_flags.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

namespace fieldcast::command_line {

namespace {

constexpr double kShortestLease_s = 0.5; // several poses on a slow connection
constexpr double kLongestLease_s = 3600.0;

struct Control {
    std::string_view word;
    std::optional<feed::CameraControl> control; ///< unset: as the scene has it
};

constexpr std::array kControls{Control{"scripted", std::nullopt}, Control{"steered", feed::CameraControl::kSteered},
                               Control{"own", feed::CameraControl::kOwn}};

/// One --camera-control: for one channel, or for all.
void read_control(const std::string& entry, channel::Settings& rendering, std::vector<std::string>& problems) {
    const std::size_t equals = entry.rfind('=');
    const std::string word = equals == std::string::npos ? entry : entry.substr(equals + 1);
    const auto known = std::ranges::find(kControls, word, &Control::word);
    if (known == kControls.end()) {
        problems.push_back("--camera-control " + entry + ": scripted, steered or own, or NAME= and one of them");
        return;
    }
    bool is_known = equals == std::string::npos;
    for (channel::ChannelChoice& channel : rendering.channels) {
        const bool is_meant = equals == std::string::npos || channel.name == entry.substr(0, equals);
        channel.control = is_meant ? known->control : channel.control;
        is_known = is_known || is_meant;
    }
    if (!is_known) {
        problems.push_back("--camera-control " + entry + ": no channel has this name");
    }
}

} // namespace

void add_camera_flags(CLI::App& app, CameraText& text) {
    app.add_option("--camera-control", text.controls,
                   "Who moves the camera: scripted (its animation), steered (one client at a time), or own (every "
                   "client has a camera); NAME=CONTROL for one channel. Repeatable.")
        ->group("Scene");
    app.add_option("--steering-lease", text.steering_lease_s,
                   "Seconds of inactivity after which the steering client loses the camera.")
        ->group("Scene")
        ->capture_default_str();
}

void read_cameras(const CameraText& text, channel::Settings& rendering, std::vector<std::string>& problems) {
    for (const bool is_for_one : {false, true}) { // what is said of one channel wins
        for (const std::string& entry : text.controls) {
            if (is_for_one == (entry.find('=') != std::string::npos)) {
                read_control(entry, rendering, problems);
            }
        }
    }
    if (!(text.steering_lease_s >= kShortestLease_s && text.steering_lease_s <= kLongestLease_s)) {
        std::ostringstream line;
        line << "--steering-lease " << text.steering_lease_s << ": " << kShortestLease_s << " to " << kLongestLease_s
             << " seconds";
        problems.push_back(line.str());
        return;
    }
    rendering.steering_lease = std::chrono::milliseconds(static_cast<std::int64_t>(text.steering_lease_s * 1e3));
}

} // namespace fieldcast::command_line
