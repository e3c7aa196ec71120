// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/source_frame.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// Timing records of frames. All times of a record are nanoseconds of one steady clock, that of the process which writes
// it; 0: unknown, or never.
namespace fieldcast::timing {

/// Times of the production of a channel's frame.
struct MadeFrame {
    std::string channel;
    std::uint64_t frame_id = 0;
    std::int64_t scene_time_ns = 0;
    std::int64_t pose_sampled_ns = 0;
    std::int64_t render_begin_ns = 0;
    std::int64_t render_end_ns = 0;
    std::int64_t encode_begin_ns = 0;
    std::int64_t encode_end_ns = 0;
    std::vector<StageTime> stages; ///< of rendering, on the device, in their order
};

/// Fate of a frame at its client, as far as it is known.
enum class Outcome : std::uint8_t {
    kUnacknowledged, ///< the client has not acknowledged it
    kDecoded,        ///< it is unknown whether it was shown
    kShown,
    kSuperseded, ///< complete, but a newer one was complete before it could be shown
    kFailed,     ///< the client could not decode it
    kAborted,    ///< sending it was stopped early
};
std::string_view to_text(Outcome outcome);

/// Times of the delivery of a frame to one client.
struct DeliveredFrame {
    MadeFrame made;
    std::uint64_t client = 0; ///< number of the session
    std::uint32_t epoch = 0;
    Outcome outcome = Outcome::kUnacknowledged;
    std::uint64_t payload_bytes = 0;
    std::int64_t send_begin_ns = 0;
    std::int64_t send_end_ns = 0;
    std::int64_t first_byte_ns = 0;
    std::int64_t last_byte_ns = 0;
    std::int64_t decoded_ns = 0;
    std::int64_t rendered_ns = 0; ///< mode SCENE: views made
    std::int64_t shown_ns = 0;
    std::int64_t clock_round_trip_ns =
        0; ///< the other side's times are wrong by at most half of it; 0: they are unset
};

/// Converts a time of another clock to our clock, which is `offset_ns` ahead of it. Returns 0 if the time is unknown or
/// no clock can show it.
std::int64_t on_our_clock(std::int64_t time_ns, std::int64_t offset_ns);

} // namespace fieldcast::timing
