// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/fanout/cost.h"
#include "bench/fanout/server_process.h"

#include <functional>
#include <optional>

namespace fieldcast::bench::fanout {

/// Settings of a comparison.
struct FanoutSettings {
    std::filesystem::path server;    ///< path of the program
    std::filesystem::path recording; ///< file that the server replays
    std::filesystem::path folder;    ///< for files that the processes exchange; must exist
    std::vector<std::size_t> clients{1, 4, 8, 16};
    std::size_t rounds = 7;
    std::size_t frames = 4; ///< number of frames of the recording that the baseline repeats
    float frames_per_second = 5.0F;
    std::chrono::milliseconds window{2000};
};

/// One round: both servers with every number of clients.
struct Round {
    std::vector<Sample> served;
    std::vector<Sample> bare;

    double ratio() const { return marginal_ms_per_megabyte(served) / marginal_ms_per_megabyte(bare); }
};

/// Measures the server's CPU time per client and byte against a gRPC server that only streams the same messages.
class FanoutRun {
public:
    explicit FanoutRun(const FanoutSettings& settings);

    /// Runs one round. Calls `after_sample` 2 · clients.size() times and throws Interrupted if it returns false.
    Round run_round(const std::function<bool()>& after_sample);

    double megabytes_per_frame() const { return megabytes_per_frame_; }
    double messages_per_frame() const { return messages_per_frame_; }

private:
    Sample measure(const ServerProcess& server, std::size_t clients) const;

    FanoutSettings settings_;
    std::optional<ServerProcess> served_;
    std::optional<ServerProcess> bare_;
    double megabytes_per_frame_ = 0.0;
    double messages_per_frame_ = 0.0;
    std::size_t round_ = 0;
};

} // namespace fieldcast::bench::fanout
