// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/latency_histogram.h"
#include "client/load/stage.h"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace fieldcast::client::load {

/// The time in which events count; it begins at the end of the ramp. Nanoseconds on the steady clock.
struct Window {
    std::int64_t begin_ns = 0;
    std::int64_t end_ns = 0;

    bool contains(std::int64_t time_ns) const { return time_ns >= begin_ns && time_ns < end_ns; }
};

/// Counts of one second of the window.
struct Second {
    std::uint64_t frames = 0;
    std::uint64_t bytes = 0;
    std::int64_t longest_due_us = 0; ///< longest due latency of the frames that arrived in it
};

/// Counts of all clients of one group. Only events in the window count, except where a field says otherwise.
struct Tally {
    std::array<LatencyHistogram, kStageCount> stages;
    std::uint64_t frames = 0;
    std::uint64_t bytes = 0;    ///< payload of complete frames
    std::uint64_t not_sent = 0; ///< frames of the channel that were skipped: no credit, `max-fps`, or a newer frame
    std::uint64_t aborted = 0;  ///< frames that the server aborted
    std::uint64_t failed = 0;   ///< frames that were damaged or not as configured
    std::uint64_t cut_off = 0;  ///< due moments that were waiting in a stall at the end
    std::uint64_t without_pose_time = 0; ///< frames whose pose time was replaced by the time of their first byte
    std::vector<Second> seconds;
    std::map<std::string, std::uint64_t> reasons; ///< of refusals and losses; at most `kMaxReasons` different ones
    std::uint64_t refused = 0;   ///< refusals by the server, at any time
    std::uint64_t lost = 0;      ///< streams that broke, at any time
    std::uint64_t sent_away = 0; ///< GoingAway messages, at any time
    std::int64_t connected = 0;  ///< clients that have a configuration now

    static constexpr std::size_t kMaxReasons = 20;

    LatencyHistogram& of(Stage stage) { return stages[static_cast<std::size_t>(stage)]; }
    const LatencyHistogram& of(Stage stage) const { return stages[static_cast<std::size_t>(stage)]; }
    Second& second_of(const Window& window, std::int64_t time_ns); ///< `time_ns` must be in the window
    void add_reason(const std::string& said);
    void add(const Tally& other);
};

/// Frames of one client in the window.
struct ClientShare {
    std::uint64_t frames = 0;
    double seconds = 0.0; ///< time during which it wanted frames

    double fps() const { return seconds > 0.0 ? static_cast<double>(frames) / seconds : 0.0; }
};

/// Jain's index: 1 if all values are equal (or all are 0), 1/n if all but one are 0.
/// Follows: R. Jain, D. Chiu, W. Hawe. A Quantitative Measure of Fairness and Discrimination for Resource Allocation in
/// Shared Computer Systems. DEC Research Report TR-301, 1984.
double jain_index(std::span<const double> shares);

} // namespace fieldcast::client::load
