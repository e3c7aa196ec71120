// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/load_run.h"

#include <algorithm>
#include <functional>
#include <gtest/gtest.h>

namespace fieldcast::test {

/// Runs a scenario until it has seen enough, however long that takes on a busy machine. Looks once a second.
inline client::load::LoadResult run_until(client::load::Scenario scenario,
                                          const std::function<bool(const client::load::LoadProgress&)>& has_enough) {
    constexpr double kPatience_s = 120.0;
    scenario.duration = client::load::Seconds(0.0); // until interrupted
    std::stop_source stop;
    const auto on_progress = [&](const client::load::LoadProgress& progress) {
        const bool is_late = progress.seconds > kPatience_s;
        EXPECT_FALSE(is_late) << "what the test waits for does not happen";
        if (is_late || (!progress.is_ramp && has_enough(progress))) {
            stop.request_stop();
        }
    };
    return client::load::run_load(scenario, on_progress, stop.get_token());
}

/// That all groups have got so many frames per client, on average.
inline std::function<bool(const client::load::LoadProgress&)> frames_for_everybody(std::uint64_t count) {
    return [count](const client::load::LoadProgress& progress) {
        return std::ranges::all_of(progress.groups,
                                   [&](const auto& group) { return group.frames >= count * group.clients; });
    };
}

} // namespace fieldcast::test
