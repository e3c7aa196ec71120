// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/steering.h"
#include "core/base/guarded.h"

#include <optional>
#include <thread>

namespace fieldcast::client::play {

/// Reads poses while we steer: one JSON object per line, from a file descriptor. Has one thread, which waits for lines.
/// Ignores lines that are not poses, with a warning in the log.
class LivePoses {
public:
    explicit LivePoses(int descriptor);

    /// The newest pose since the last call, if any. Its `cut` is set if one of the poses since then was a jump.
    std::optional<net::WantedPose> take();

private:
    void read_until(const std::stop_token& stop, int descriptor);
    void add(const std::string& line, std::uint64_t number);

    Guarded<std::optional<net::WantedPose>> newest_;
    std::jthread thread_;
};

} // namespace fieldcast::client::play
