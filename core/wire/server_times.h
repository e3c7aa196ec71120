// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace fieldcast::wire {

/// Moments in the life of a frame: nanoseconds on the server's steady clock; 0: unknown.
struct ServerTimes {
    std::int64_t pose_sampled_ns = 0;
    std::int64_t render_begin_ns = 0;
    std::int64_t render_end_ns = 0;
    std::int64_t encode_begin_ns = 0;
    std::int64_t encode_end_ns = 0;
    std::int64_t send_begin_ns = 0; ///< header chunk handed to the transport
    std::int64_t send_end_ns = 0;   ///< last strip chunk handed to the transport

    bool operator==(const ServerTimes&) const = default;
};

} // namespace fieldcast::wire
