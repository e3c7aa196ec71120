// SPDX-License-Identifier: Apache-2.0
#include "client/load/tally.h"

#include "core/base/printable.h"

#include <algorithm>

namespace fieldcast::client::load {

Second& Tally::second_of(const Window& window, std::int64_t time_ns) {
    constexpr std::int64_t kNsPerSecond = 1'000'000'000;
    const auto index = static_cast<std::size_t>((time_ns - window.begin_ns) / kNsPerSecond);
    if (index >= seconds.size()) {
        seconds.resize(index + 1);
    }
    return seconds[index];
}

void Tally::add_reason(const std::string& said) {
    const std::string reason = printable(said); // it may contain text from the server
    const auto known = reasons.find(reason);
    if (known != reasons.end()) {
        ++known->second;
    } else {
        ++reasons[reasons.size() < kMaxReasons ? reason : "others"];
    }
}

void Tally::add(const Tally& other) {
    for (std::size_t i = 0; i < kStageCount; ++i) {
        stages[i].add(other.stages[i]);
    }
    frames += other.frames;
    bytes += other.bytes;
    not_sent += other.not_sent;
    aborted += other.aborted;
    failed += other.failed;
    cut_off += other.cut_off;
    without_pose_time += other.without_pose_time;
    seconds.resize(std::max(seconds.size(), other.seconds.size()));
    for (std::size_t i = 0; i < other.seconds.size(); ++i) {
        seconds[i].frames += other.seconds[i].frames;
        seconds[i].bytes += other.seconds[i].bytes;
        seconds[i].longest_due_us = std::max(seconds[i].longest_due_us, other.seconds[i].longest_due_us);
    }
    for (const auto& [reason, count] : other.reasons) {
        reasons[reason] += count;
    }
    refused += other.refused;
    lost += other.lost;
    sent_away += other.sent_away;
    connected += other.connected;
}

double jain_index(std::span<const double> shares) {
    double sum = 0.0;
    double squares = 0.0;
    for (const double share : shares) {
        sum += share;
        squares += share * share;
    }
    return squares > 0.0 ? sum * sum / (static_cast<double>(shares.size()) * squares) : 1.0;
}

} // namespace fieldcast::client::load
