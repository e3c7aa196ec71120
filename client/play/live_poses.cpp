// SPDX-License-Identifier: Apache-2.0
#include "client/play/live_poses.h"

#include "client/play/pose_text.h"
#include "core/base/error.h"
#include "core/base/log.h"

#include <array>
#include <poll.h>
#include <unistd.h>
#include <utility>

namespace fieldcast::client::play {
namespace {

constexpr int kLookAtStop_ms = 100;
constexpr std::size_t kMaxLineBytes = 64 << 10;

} // namespace

LivePoses::LivePoses(int descriptor)
    : thread_([this, descriptor](const std::stop_token& stop) { read_until(stop, descriptor); }) {}

std::optional<net::WantedPose> LivePoses::take() {
    return std::exchange(*newest_.lock(), std::nullopt);
}

void LivePoses::read_until(const std::stop_token& stop, int descriptor) {
    std::string text;
    std::uint64_t number = 0;
    std::array<char, 4096> block{};
    while (!stop.stop_requested()) {
        pollfd waiting{.fd = descriptor, .events = POLLIN, .revents = 0};
        if (::poll(&waiting, 1, kLookAtStop_ms) <= 0) {
            continue; // no input yet, or a signal
        }
        const ssize_t count = ::read(descriptor, block.data(), block.size());
        if (count <= 0 || text.size() > kMaxLineBytes) {
            return; // end of input, or a line that is too long
        }
        text.append(block.data(), static_cast<std::size_t>(count));
        for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
            add(text.substr(0, end), ++number);
            text.erase(0, end + 1);
        }
    }
}

void LivePoses::add(const std::string& line, std::uint64_t number) {
    try {
        net::WantedPose pose = parse_pose(line, "line " + std::to_string(number));
        auto newest = newest_.lock();
        pose.cut = pose.cut || (*newest && (*newest)->cut);
        *newest = pose;
    } catch (const UserError& problem) {
        log::warn("line is not a pose", {{"problem", problem.what()}});
    }
}

} // namespace fieldcast::client::play
