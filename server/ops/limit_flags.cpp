// SPDX-License-Identifier: Apache-2.0
#include "server/ops/limit_flags.h"

#include <CLI/CLI.hpp>
#include <sstream>

namespace fieldcast::ops {

namespace {

constexpr std::uint32_t kMaxCount = 4096;       // of sessions or downloads
constexpr std::uint32_t kMaxOwnCameras = 256;   // each has two threads and the scene on the device
constexpr double kMaxRate = 1e6;                // per second
constexpr std::uint64_t kMaxAmount = 1ULL << 44; // bytes or pixels; sums of a few thousand stay below 2^63

template <class T>
void expect(std::vector<std::string>& problems, const char* flag, T value, T least, T most) {
    if (!(value >= least && value <= most)) {
        std::ostringstream line;
        line << flag << ' ' << value << ": " << least << " to " << most;
        problems.push_back(line.str());
    }
}

} // namespace

void add_limit_flags(CLI::App& app, Config& config) {
    session::Limits& limits = config.limits;
    const auto add = [&](const char* flag, auto& value, const char* help) {
        app.add_option(flag, value, help)->group("Limits")->capture_default_str();
    };
    add("--max-connections", limits.max_connections, "At the same time; fewer if there are few descriptors");
    add("--max-sessions", limits.max_sessions, "Clients at the same time");
    add("--max-sessions-per-peer", limits.max_sessions_per_peer,
        "Of one address; the last eighth of all is kept for addresses that have none");
    add("--max-opens-per-second-per-peer", limits.max_opens_per_second_per_peer,
        "Sessions that one address may open on average; --max-sessions-per-peer of them at once");
    add("--max-messages-per-second", limits.max_messages_per_second,
        "Of one session on average, twice as many at once; a Configure counts as 50, every 128 bytes as one");
    add("--max-poses-per-second", limits.max_poses_per_second,
        "Of one session that steers, on average; as many at once");
    add("--max-own-cameras", limits.max_own_cameras, "Of clients that have one each, at the same time");
    add("--max-own-cameras-per-peer", limits.max_own_cameras_per_peer,
        "Of clients of one address; the last ones are kept for addresses that have none");
    add("--own-camera-budget", config.own_camera_budget_ms,
        "Milliseconds of the device per second that are promised to all own cameras; whoever is alone gets one anyway");
    add("--max-channel-pixels", config.max_channel_pixels, "That a channel encodes for one frame, over all clients");
    app.add_option("--max-view-memory", config.max_view_memory,
                   "Bytes of the device's memory for views of all clients; default: half of what is free at the start")
        ->group("Limits");
    add("--max-pixels-per-peer", limits.max_pixels_per_peer, "Of all views that the server makes for one address");
    add("--max-bytes-in-flight", limits.max_bytes_in_flight, "Unacknowledged, of one session");
    add("--max-bytes-in-flight-per-peer", limits.max_bytes_in_flight_per_peer,
        "Unacknowledged, of one address; the last eighth of all is kept for addresses that have none");
    add("--max-bytes-in-flight-in-total", limits.max_bytes_in_flight_in_total, "Unacknowledged, of everybody");
    add("--max-scene-downloads", limits.max_scene_downloads, "At the same time");
    add("--max-scene-downloads-per-peer", limits.max_scene_downloads_per_peer,
        "At the same time, of one address; the last eighth of all is kept for addresses that have none");
}

std::vector<std::string> limit_problems(const Config& config) {
    const session::Limits& limits = config.limits;
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
    expect(problems, "--own-camera-budget", config.own_camera_budget_ms, 1.0, kMaxRate);
    expect_amount("--max-channel-pixels", config.max_channel_pixels);
    expect_amount("--max-view-memory", config.max_view_memory.value_or(1));
    expect_amount("--max-pixels-per-peer", limits.max_pixels_per_peer);
    expect_amount("--max-bytes-in-flight", limits.max_bytes_in_flight);
    expect_amount("--max-bytes-in-flight-per-peer", limits.max_bytes_in_flight_per_peer);
    expect_amount("--max-bytes-in-flight-in-total", limits.max_bytes_in_flight_in_total);
    expect(problems, "--max-opens-per-second-per-peer", limits.max_opens_per_second_per_peer, 0.01, kMaxRate);
    expect(problems, "--max-messages-per-second", limits.max_messages_per_second, 50.0, kMaxRate);
    expect(problems, "--max-poses-per-second", limits.max_poses_per_second, 1.0, kMaxRate);
    return problems;
}

} // namespace fieldcast::ops
