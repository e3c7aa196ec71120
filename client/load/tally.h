// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/latency_histogram.h"
#include "client/load/stage.h"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace fieldcast::client::load {

/// What is counted, and when: from the end of the ramp on. Nanoseconds on the steady clock.
struct Window {
    std::int64_t begin_ns = 0;
    std::int64_t end_ns = 0;

    bool contains(std::int64_t time_ns) const { return time_ns >= begin_ns && time_ns < end_ns; }
};

/// What happened in one second of the window.
struct Second {
    std::uint64_t frames = 0;
    std::uint64_t bytes = 0;
    std::int64_t longest_due_us = 0; ///< of the frames that arrived in it
};

/// What clients of one group saw. Only what happened in the window, but for the last three.
struct Tally {
    std::array<LatencyHistogram, kStageCount> stages;
    std::uint64_t frames = 0;
    std::uint64_t bytes = 0;    ///< payload of complete frames
    std::uint64_t not_sent = 0; ///< frames of the channel that a client did not get: credits, its rate, a newer one
    std::uint64_t aborted = 0;  ///< given up by the server half way
    std::uint64_t failed = 0;   ///< damaged, or not what was agreed
    std::uint64_t cut_off = 0;  ///< due moments that the end of the run found waiting in a stall
    std::uint64_t without_pose_time = 0; ///< frames whose first byte had to stand for their pose
    std::vector<Second> seconds;
    std::map<std::string, std::uint64_t> reasons; ///< of refusals and losses, at most `kMaxReasons` different ones
    std::uint64_t refused = 0;   ///< at any time
    std::uint64_t lost = 0;      ///< streams that broke, at any time
    std::uint64_t sent_away = 0; ///< GoingAway, at any time
    std::int64_t connected = 0;  ///< clients with a configuration, now

    static constexpr std::size_t kMaxReasons = 20;

    LatencyHistogram& of(Stage stage) { return stages[static_cast<std::size_t>(stage)]; }
    const LatencyHistogram& of(Stage stage) const { return stages[static_cast<std::size_t>(stage)]; }
    Second& second_of(const Window& window, std::int64_t time_ns); ///< `time_ns` must be in the window
    void add_reason(const std::string& said);
    void add(const Tally& other);
};

/// What one client got in the window.
struct ClientShare {
    std::uint64_t frames = 0;
    double seconds = 0.0; ///< that it wanted frames

    double fps() const { return seconds > 0.0 ? static_cast<double>(frames) / seconds : 0.0; }
};

/// 1: all have the same; 1/n: one has everything. 1 if nobody has anything.
/// Follows: R. Jain, D. Chiu, W. Hawe. A Quantitative Measure of Fairness and Discrimination for Resource Allocation in
/// Shared Computer Systems. DEC Research Report TR-301, 1984.
double jain_index(std::span<const double> shares);

} // namespace fieldcast::client::load
