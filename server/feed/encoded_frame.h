// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/wire/chunks.h"
#include "server/feed/selection.h"

#include <chrono>
#include <memory>
#include <optional>
#include <vector>

namespace fieldcast::feed {

/// One frame of a channel in every form that a client wanted when it was begun. Never changed once published.
struct EncodedFrame {
    FrameHeader header;
    wire::ServerTimes times;        ///< without the send times, which differ between clients
    std::uint64_t key_frame_id = 0; ///< key frame that strips may refer to; 0: none; its own id: it is a key frame
    std::optional<wire::EncodedSource> source;
    std::vector<wire::EncodedViews> views;
    std::optional<std::chrono::steady_clock::time_point> begun{}; ///< feed::Demand::begun; unset: made without a Demand
};

using FramePtr = std::shared_ptr<const EncodedFrame>;

/// The views of that format; null if absent.
const wire::EncodedViews* find_views(const EncodedFrame& frame, const wire::ViewFormat& format);

/// Whether `frame` contains everything in `selection`. A frame begun before a client changed its selection may not.
bool covers(const EncodedFrame& frame, const Selection& selection);

/// Whether everything in `selection`, which the frame must cover, can be sent to a client without the key frame.
bool stands_alone(const EncodedFrame& frame, const Selection& selection);

} // namespace fieldcast::feed
