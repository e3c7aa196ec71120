// SPDX-License-Identifier: Apache-2.0
#include "server/command_line/limit_flags.h"

#include <CLI/CLI.hpp>

namespace fieldcast::command_line {

void add_limit_flags(CLI::App& app, config::Config& config) {
    session::Limits& limits = config.limits;
    const auto add = [&](const char* flag, auto& value, const char* help) {
        app.add_option(flag, value, help)->group("Limits")->capture_default_str();
    };
    add("--max-connections", limits.max_connections, "Connections at the same time; fewer if descriptors are scarce.");
    add("--max-sessions", limits.max_sessions, "Sessions at the same time.");
    add("--max-sessions-per-peer", limits.max_sessions_per_peer,
        "Sessions of one address; the last eighth of --max-sessions is kept for addresses without a session.");
    add("--max-opens-per-second-per-peer", limits.max_opens_per_second_per_peer,
        "Sessions that one address may open per second on average; --max-sessions-per-peer of them at once.");
    add("--max-messages-per-second", limits.max_messages_per_second,
        "Messages of one session per second on average, twice as many at once; a Configure counts as 50, every 128 "
        "bytes as one.");
    add("--max-poses-per-second", limits.max_poses_per_second,
        "Poses of one steering session per second on average; as many at once.");
    add("--max-own-cameras", limits.max_own_cameras, "Clients with an own camera at the same time.");
    add("--max-own-cameras-per-peer", limits.max_own_cameras_per_peer,
        "Own cameras of one address; the last ones are kept for addresses without one.");
    add("--own-camera-budget", config.rendering.own_cameras.max_ms_per_second,
        "Device time reserved for all own cameras, milliseconds per second; a single client always gets a camera.");
    add("--max-channel-pixels", config.rendering.max_channel_pixels,
        "Pixels that a channel encodes for one frame, over all clients.");
    app.add_option("--max-view-memory", config.rendering.max_view_memory,
                   "Device memory for views of all clients, bytes; default: half of what is free at the start.")
        ->group("Limits");
    add("--max-pixels-per-peer", limits.max_pixels_per_peer,
        "Pixels of all views that the server makes for one address.");
    add("--max-bytes-in-flight", limits.max_bytes_in_flight, "Unacknowledged bytes of one session.");
    add("--max-bytes-in-flight-per-peer", limits.max_bytes_in_flight_per_peer,
        "Unacknowledged bytes of one address; the last eighth of the total is kept for addresses without a session.");
    add("--max-bytes-in-flight-in-total", limits.max_bytes_in_flight_in_total, "Unacknowledged bytes of all sessions.");
    add("--max-scene-downloads", limits.max_scene_downloads, "Scene downloads at the same time.");
    add("--max-scene-downloads-per-peer", limits.max_scene_downloads_per_peer,
        "Scene downloads of one address; the last eighth of all is kept for addresses without a download.");
}

} // namespace fieldcast::command_line
