// SPDX-License-Identifier: Apache-2.0
#include "server/channel/frame_encoder.h"

#include <algorithm>
#include <chrono>

namespace fieldcast::channel {

namespace {

std::int64_t steady_ns() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

/// Views of that geometry and size in the key frame; null if it has none.
const Views* find_views(const RenderedFrame& key, const RenderedViews& wanted) {
    const auto found = std::ranges::find_if(key.views, [&](const RenderedViews& views) {
        return is_same_batch(views.formats.front(), wanted.formats.front());
    });
    return found == key.views.end() ? nullptr : &found->views;
}

} // namespace

wire::KeyFrame FrameEncoder::key_for(const RenderedFrame& frame, bool is_key) const {
    wire::KeyFrame key;
    key.frame_id = is_key ? frame.header.frame_id : key_->header.frame_id;
    key.is_optional = frame.needs_alone;
    if (!is_key && key_->source) {
        key.source = &*key_->source;
    }
    return key;
}

feed::FramePtr FrameEncoder::encode(RenderedFrame frame, TimePoint now) {
    frame.times.encode_begin_ns = steady_ns();
    const bool is_key = key_frames_.next(now, frame.needs_key || frame.header.cut);
    wire::KeyFrame key = key_for(frame, is_key);
    auto encoded = std::make_shared<feed::EncodedFrame>();
    encoded->header = frame.header;
    encoded->times = frame.times;
    encoded->key_frame_id = key.frame_id;
    encoded->begun = frame.begun;
    if (frame.source) {
        encoded->source = wire::encode_source(*frame.source, frame.choices, key, pool_);
    }
    for (const RenderedViews& rendered : frame.views) {
        key.views = is_key ? nullptr : find_views(*key_, rendered);
        for (const wire::ViewFormat& format : rendered.formats) {
            encoded->views.push_back(wire::encode_views(rendered.views, format, key, pool_));
        }
    }
    encoded->times.encode_end_ns = steady_ns();
    if (is_key) {
        key_ = std::make_unique<const RenderedFrame>(std::move(frame));
    }
    return encoded;
}

} // namespace fieldcast::channel
