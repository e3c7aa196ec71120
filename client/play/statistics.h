// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/views.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fieldcast::client::play {

/// Measurements of one shown frame. Times that need the server's clock are unset before the clocks are synchronised.
struct ShownFrame {
    std::uint64_t frame_id = 0;
    std::uint64_t payload_bytes = 0;
    std::optional<double> send_to_decoded_ms;
    std::optional<double> pose_to_decoded_ms;
    std::optional<double> pose_to_shown_ms;
    std::optional<double> motion_to_photon_ms; ///< from choosing a pose to showing the first frame with it
    double decode_ms = 0.0;
    double render_ms = 0.0; ///< making the views; 0 when they were received
    std::int64_t shown_ns = 0;
    std::uint64_t view_pixels = 0; ///< of all views
    std::uint64_t out_of_frustum = 0;
    std::uint64_t id = 0;
    std::uint64_t plane = 0;
    std::uint64_t normal = 0;
};

/// Adds the discards and the number of pixels of `views` to `frame`.
void add_discards(const Views& views, ShownFrame& frame);

/// Counts of sessions and configurations, and of frames that were not shown.
struct StreamCounts {
    std::uint32_t sessions = 0;   ///< streams that were granted a configuration; 1 without reconnects
    std::uint64_t changes = 0;    ///< further configurations of running streams that we requested
    std::uint64_t adaptations = 0; ///< further configurations that the server chose by itself
    std::uint64_t superseded = 0; ///< frames that were not shown because a newer one was complete
    std::uint64_t aborted = 0;    ///< frames that the server abandoned
    std::uint64_t failed = 0;     ///< frames that could not be decoded or did not match the agreement
};

/// Frames of one configuration, in the order in which they were shown.
struct EpochSummary {
    std::uint32_t session = 0; ///< number of the session, from 1
    std::uint32_t epoch = 0;   ///< within the session
    std::string mode;
    std::string grid;
    std::string view_size;
    std::uint64_t shown = 0;
    std::uint64_t first_frame = 0; ///< frame id
    std::uint64_t last_frame = 0;  ///< frame id
    double bytes_per_frame = 0.0;
    std::string reason; ///< of a change by the server; empty: the client requested it
};

/// In milliseconds.
struct Percentiles {
    double p50 = 0.0;
    double p95 = 0.0;
};

/// Content of the table and of the JSON file.
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
    std::uint64_t poses_shown = 0;                   ///< of poses that we chose
    Percentiles decode_ms;
    Percentiles render_ms;
    double discarded_percent = 0.0; ///< of all pixels of all views
    double out_of_frustum_percent = 0.0;
    double id_percent = 0.0;
    double plane_percent = 0.0;
    double normal_percent = 0.0;
    std::vector<std::uint64_t> frame_ids; ///< shown, in order
    std::vector<EpochSummary> epochs;     ///< the last 256
};

/// All but mode, grid, view size and epochs, from `frames` in the order in which they were shown.
Summary summarise(const std::vector<ShownFrame>& frames, const StreamCounts& counts);

/// Lines of "key  value", for people.
std::string to_table(const Summary& summary);

/// One JSON object. Keys end in their unit, like the members above. Unknown times are null.
std::string to_json(const Summary& summary);

} // namespace fieldcast::client::play
