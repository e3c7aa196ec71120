// SPDX-License-Identifier: Apache-2.0
#include "server/channel/frame_encoder.h"

#include <chrono>

namespace fieldcast::channel {

feed::FramePtr encode(const RenderedFrame& frame, WorkerPool& pool) {
    auto encoded = std::make_shared<feed::EncodedFrame>();
    encoded->header = frame.header;
    encoded->times = frame.times;
    if (frame.source) {
        encoded->source = wire::encode_source(*frame.source, frame.choices, pool);
    }
    for (const RenderedViews& rendered : frame.views) {
        for (const wire::ViewFormat& format : rendered.formats) {
            encoded->views.push_back(wire::encode_views(rendered.views, format, pool));
        }
    }
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    encoded->times.encode_end_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
    return encoded;
}

} // namespace fieldcast::channel
