// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/views.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fieldcast::client::play {

/// What is known about one shown frame. Times are milliseconds; unset before the clocks are in step.
struct ShownFrame {
    std::uint64_t frame_id = 0;
    std::uint64_t payload_bytes = 0;
    std::optional<double> send_to_decoded_ms;
    std::optional<double> pose_to_decoded_ms;
    std::optional<double> pose_to_shown_ms;
    std::optional<double> motion_to_photon_ms; ///< from choosing a pose to showing the first frame that has it
    double decode_ms = 0.0;
    double render_ms = 0.0; ///< making the views; 0 when they were received
    std::int64_t shown_ns = 0;
    std::uint64_t view_pixels = 0; ///< of all views
    std::uint64_t out_of_frustum = 0;
    std::uint64_t id = 0;
    std::uint64_t plane = 0;
    std::uint64_t normal = 0;
};

/// Fills in the discards and the number of pixels.
void add_discards(const Views& views, ShownFrame& frame);

/// Frames that were not shown, by reason, and what happened to the connection.
struct StreamCounts {
    std::uint32_t sessions = 0;   ///< streams that were granted a configuration; 1 without reconnects
    std::uint64_t changes = 0;    ///< further configurations on running streams that we asked for
    std::uint64_t adaptations = 0; ///< those that the server made by itself
    std::uint64_t superseded = 0; ///< complete, but a newer one was complete before it could be shown
    std::uint64_t aborted = 0;    ///< by the server, half way
    std::uint64_t failed = 0;     ///< undecodable, or not what was agreed
};

/// Frames of one configuration, in the order in which they were shown.
struct EpochSummary {
    std::uint32_t session = 0; ///< epochs count within one
    std::uint32_t epoch = 0;
    std::string mode;
    std::string grid;
    std::string view_size;
    std::uint64_t shown = 0;
    std::uint64_t first_frame = 0; ///< ids
    std::uint64_t last_frame = 0;
    double bytes_per_frame = 0.0;
    std::string reason; ///< empty: the client asked for it
};

struct Percentiles {
    double p50 = 0.0;
    double p95 = 0.0;
};

/// What the table and the JSON file say.
struct Summary {
    std::string mode;
    std::string grid;
    std::string view_size;
    std::uint64_t shown = 0;
    StreamCounts counts;
    double frames_per_second = 0.0; ///< shown frames; 0 for fewer than two
    double bytes_per_frame = 0.0;
    std::optional<Percentiles> send_to_decoded_ms;
    std::optional<Percentiles> pose_to_decoded_ms;
    std::optional<Percentiles> pose_to_shown_ms;
    std::optional<Percentiles> motion_to_photon_ms; ///< of poses that we chose
    std::uint64_t poses_shown = 0;                   ///< likewise
    Percentiles decode_ms;
    Percentiles render_ms;
    double discarded_percent = 0.0; ///< of all pixels of all views
    double out_of_frustum_percent = 0.0;
    double id_percent = 0.0;
    double plane_percent = 0.0;
    double normal_percent = 0.0;
    std::vector<std::uint64_t> frame_ids; ///< shown, in order
    std::vector<EpochSummary> epochs;     ///< the last ones
};

Summary summarise(const std::vector<ShownFrame>& frames, const StreamCounts& counts);

/// "key  value" lines for people.
std::string to_table(const Summary& summary);

/// One object; keys carry their unit, as the members above. Times that are unknown are null.
std::string to_json(const Summary& summary);

} // namespace fieldcast::client::play
