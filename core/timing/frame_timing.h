// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/source_frame.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// What is known about when a frame was where. All times of a record are nanoseconds of one steady clock, that of the
// process which writes it; 0: unknown, or never.
namespace fieldcast::timing {

/// How a frame of a channel was made.
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

/// What became of a frame at its client, as far as is known.
enum class Outcome : std::uint8_t {
    kUnacknowledged, ///< nothing was heard of it
    kDecoded,        ///< whether it was shown is not known
    kShown,
    kSuperseded, ///< complete, but a newer one was complete before it could be shown
    kFailed,     ///< the client could not decode it
    kAborted,    ///< not sent to its end
};
std::string_view to_text(Outcome outcome);

/// The way of a frame to one client.
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
        0; ///< times of the other side are wrong by half of it at most; 0: they are unset
};

/// A time of another clock on ours, which is `offset_ns` ahead of it. 0: unknown, or no time that a clock can show.
std::int64_t on_our_clock(std::int64_t time_ns, std::int64_t offset_ns);

} // namespace fieldcast::timing
