// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/steering.h"
#include "core/base/guarded.h"

#include <optional>
#include <thread>

namespace fieldcast::client::play {

/// Poses that come while we steer: JSON objects, one a line, from a file descriptor. Has one thread, which waits for
/// lines. A line that is no pose is told in the log and passed over.
class LivePoses {
public:
    explicit LivePoses(int descriptor);

    /// The newest pose since the last call; its `cut` is set if any since then was a jump.
    std::optional<net::WantedPose> take();

private:
    void read_until(const std::stop_token& stop, int descriptor);
    void add(const std::string& line, std::uint64_t number);

    Guarded<std::optional<net::WantedPose>> newest_;
    std::jthread thread_;
};

} // namespace fieldcast::client::play
