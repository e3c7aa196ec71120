// SPDX-License-Identifier: Apache-2.0
// The numbers of docs/protocol.md, "Limits and deadlines", are those of the code.
#include "server/config/config.h"
#include "server/session/credits.h"

#include <fstream>
#include <gmock/gmock.h>
#include <map>

namespace fieldcast::command_line {
namespace {

using std::chrono::milliseconds;

/// Rows of the section's tables: the first cell, then the rest.
std::map<std::string, std::string> rows() {
    std::ifstream page("docs/protocol.md");
    std::map<std::string, std::string> rows;
    bool is_there = false;
    for (std::string line; std::getline(page, line);) {
        is_there = is_there || line == "## Limits and deadlines";
        const std::size_t end = line.find(" | ", 2);
        if (is_there && line.starts_with("| ") && end != std::string::npos) {
            rows[line.substr(2, end - 2)] = line.substr(end + 2);
        }
    }
    return rows;
}

/// With commas between thousands from 10,000 on, and without a fraction.
template <class Number> std::string number(Number value) {
    const std::string plain = std::to_string(static_cast<std::uint64_t>(value));
    std::string digits;
    for (std::size_t left = plain.size(); const char digit : plain) {
        digits += digit;
        --left;
        if (plain.size() > 4 && left > 0 && left % 3 == 0) {
            digits += ',';
        }
    }
    return digits;
}

std::string bytes(std::uint64_t value) {
    const bool is_gib = value % (1ULL << 30) == 0;
    const bool is_mib = value % (1ULL << 20) == 0;
    return is_gib   ? number(value >> 30) + " GiB"
           : is_mib ? number(value >> 20) + " MiB"
                    : number(value >> 10) + " KiB";
}

std::string seconds(milliseconds value) {
    return value.count() % 1000 == 0 ? std::to_string(value.count() / 1000) + " s"
                                     : std::to_string(value.count()) + " ms";
}

TEST(ProtocolPage, HasTheLimitsOfTheServer) {
    const config::Config config;
    const session::Limits& limits = config.limits;
    const auto page = rows();
    const auto expect = [&](const std::string& row, const std::string& text) {
        const auto found = page.find(row);
        ASSERT_NE(found, page.end()) << row;
        EXPECT_THAT(found->second, testing::HasSubstr(text)) << row;
    };
    const auto of_peer = [](std::uint32_t all, std::uint32_t peer) {
        return number(all) + ", of one peer " + number(peer);
    };
    expect("handshake of TCP, TLS and HTTP/2", seconds(limits.handshake_deadline));
    expect("connections at the same time", number(limits.max_connections));
    expect("silence", std::string("after ") + seconds(limits.keepalive_interval));
    expect("silence", std::string("within ") + seconds(limits.keepalive_timeout));
    expect("connection without calls", std::string("after ") + seconds(limits.idle_deadline));
    expect("message of a client", bytes(session::kMaxClientMessageBytes) + ",");
    expect("sessions", of_peer(limits.max_sessions, limits.max_sessions_per_peer));
    expect("opening", number(limits.max_opens_per_second_per_peer) + " a second of one peer");
    expect("first granted `Configure`", std::string("within ") + seconds(limits.configure_deadline));
    expect("messages", number(limits.max_messages_per_second) + " a second");
    expect("messages", std::string("a `Configure` counts as ") + number(session::kConfigureWeight));
    expect("answers that wait to be sent", number(session::kMaxQueuedAnswers) + ";");
    expect("poses", number(limits.max_poses_per_second) + " a second");
    expect("lease of a camera", std::string("ends ") + seconds(config.rendering.steering_lease));
    expect("frames in flight", number(session::kMinCredits) + " to " + number(session::kMaxCredits));
    expect("bytes in flight", bytes(limits.max_bytes_in_flight) + ", of one peer " +
                                  bytes(limits.max_bytes_in_flight_per_peer) + ", in total " +
                                  bytes(limits.max_bytes_in_flight_in_total));
    expect("acknowledgement", std::string("within ") + seconds(limits.stall_deadline));
    expect("unread message", seconds(limits.stall_deadline));
    expect("`GoingAway`", seconds(limits.going_away_deadline));
    expect("heartbeats", std::string("every ") + seconds(limits.heartbeat_interval));
    expect("views", number(kMaxViews) + " of one grid");
    expect("views", std::string("at most ") + number(limits.max_view_set_pixels));
    expect("views of one peer", number(limits.max_pixels_per_peer));
    expect("views of one channel", number(config.rendering.max_channel_pixels));
    expect("own cameras", std::string("of one peer ") + number(limits.max_own_cameras_per_peer));
    expect("scene downloads", of_peer(limits.max_scene_downloads, limits.max_scene_downloads_per_peer));
    expect("chunk of a scene that is not read", seconds(limits.stall_deadline));
    expect("channel without frames", seconds(limits.channel_deadline));
}

} // namespace
} // namespace fieldcast::command_line
