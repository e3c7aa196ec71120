// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/parallel.h"
#include "server/channel/frame_renderer.h"
#include "server/channel/key_frames.h"
#include "server/feed/encoded_frame.h"

#include <memory>

namespace fieldcast::channel {

/// Encodes the frames of one channel in order: every plane and every view once per requested codec. Keeps the last
/// key frame, to which strips of later frames refer. Not thread-safe; uses all cores.
class FrameEncoder {
public:
    using TimePoint = KeyFrames::TimePoint;

    /// `now` decides on key frames.
    feed::FramePtr encode(RenderedFrame frame, TimePoint now);

private:
    /// The key frame to which planes of `frame` may refer; that of views depends on their format.
    wire::KeyFrame key_for(const RenderedFrame& frame, bool is_key) const;

    WorkerPool pool_;
    KeyFrames key_frames_;
    std::unique_ptr<const RenderedFrame> key_; ///< null before the first
};

} // namespace fieldcast::channel
