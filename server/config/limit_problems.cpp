// SPDX-License-Identifier: Apache-2.0
#include "server/config/limit_problems.h"

#include <cstdint>
#include <sstream>

namespace fieldcast::config {

namespace {

constexpr std::uint32_t kMaxCount = 4096;        // of sessions or downloads
constexpr std::uint32_t kMaxOwnCameras = 256;    // each has two threads and the scene on the device
constexpr double kMaxRate = 1e6;                 // per second
constexpr std::uint64_t kMaxAmount = 1ULL << 44; // bytes or pixels; sums of a few thousand stay below 2^63

template <class T> void expect(std::vector<std::string>& problems, const char* flag, T value, T least, T most) {
    if (!(value >= least && value <= most)) {
        std::ostringstream line;
        line << flag << ' ' << value << ": " << least << " to " << most;
        problems.push_back(line.str());
    }
}

} // namespace

std::vector<std::string> limit_problems(const session::Limits& limits, const channel::Settings& rendering) {
    std::vector<std::string> problems;
    const auto expect_count = [&](const char* flag, std::uint32_t value) {
        expect(problems, flag, value, 1U, kMaxCount);
    };
    const auto expect_amount = [&](const char* flag, std::uint64_t value) {
        expect(problems, flag, value, std::uint64_t{1}, kMaxAmount);
    };
    expect_count("--max-connections", limits.max_connections);
    expect_count("--max-sessions", limits.max_sessions);
    expect_count("--max-sessions-per-peer", limits.max_sessions_per_peer);
    expect_count("--max-scene-downloads", limits.max_scene_downloads);
    expect_count("--max-scene-downloads-per-peer", limits.max_scene_downloads_per_peer);
    expect(problems, "--max-own-cameras", limits.max_own_cameras, 1U, kMaxOwnCameras);
    expect(problems, "--max-own-cameras-per-peer", limits.max_own_cameras_per_peer, 1U, kMaxOwnCameras);
    expect(problems, "--own-camera-budget", rendering.own_cameras.max_ms_per_second, 1.0, kMaxRate);
    expect_amount("--max-channel-pixels", rendering.max_channel_pixels);
    expect_amount("--max-view-memory", rendering.max_view_memory.value_or(1));
    expect_amount("--max-pixels-per-peer", limits.max_pixels_per_peer);
    expect_amount("--max-bytes-in-flight", limits.max_bytes_in_flight);
    expect_amount("--max-bytes-in-flight-per-peer", limits.max_bytes_in_flight_per_peer);
    expect_amount("--max-bytes-in-flight-in-total", limits.max_bytes_in_flight_in_total);
    expect(problems, "--max-opens-per-second-per-peer", limits.max_opens_per_second_per_peer, 0.01, kMaxRate);
    expect(problems, "--max-messages-per-second", limits.max_messages_per_second, 50.0, kMaxRate);
    expect(problems, "--max-poses-per-second", limits.max_poses_per_second, 1.0, kMaxRate);
    return problems;
}

} // namespace fieldcast::config
