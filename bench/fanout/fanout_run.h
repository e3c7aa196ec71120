// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/fanout/cost.h"
#include "bench/fanout/server_process.h"

#include <functional>
#include <optional>

namespace fieldcast::bench::fanout {

/// What is compared, and for how long.
struct FanoutSettings {
    std::filesystem::path server;    ///< program
    std::filesystem::path recording; ///< that it replays
    std::filesystem::path folder;    ///< for files that the processes exchange; must exist
    std::vector<std::size_t> clients{1, 4, 8, 16};
    std::size_t rounds = 7;
    std::size_t frames = 4; ///< of the recording, that the yardstick repeats
    float frames_per_second = 5.0F;
    std::chrono::milliseconds window{2000};
};

/// One round: both servers with every number of clients.
struct Round {
    std::vector<Sample> served;
    std::vector<Sample> bare;

    double ratio() const { return marginal_ms_per_megabyte(served) / marginal_ms_per_megabyte(bare); }
};

/// What the server's processor time per client and byte is, against a gRPC server that only streams the same messages.
class FanoutRun {
public:
    explicit FanoutRun(const FanoutSettings& settings);

    /// Calls `after_sample` 2 · clients.size() times; if it returns false, throws Interrupted.
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
