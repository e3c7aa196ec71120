// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/channel/channel_clock.h"
#include "server/channel/channel_metrics.h"
#include "server/channel/frame_renderer.h"
#include "server/channel/handoff.h"
#include "server/feed/feed.h"

#include <memory>
#include <thread>

namespace fieldcast::channel {

/// Scene + camera + time + lattice of views: renders while somebody subscribes to its feed, sleeps otherwise.
/// One thread renders, one encodes and publishes the frame before; neither ever waits for a client.
class Channel {
public:
    /// Ready to serve when constructed; rendering starts with the first subscriber. `device`, `config` and
    /// `registry` must outlive it. Throws UserError if the scene is not usable.
    Channel(const gpu::Device& device, const ops::Config& config, const ops::ChannelChoice& choice,
            metrics::Registry& registry);
    ~Channel();

    const std::shared_ptr<feed::Feed>& feed() const { return feed_; }

private:
    void render_loop(const std::stop_token& stop);
    FrameMoment next_moment(ChannelClock::TimePoint now); ///< of the frame that begins now
    bool wait_for_demand(const std::stop_token& stop); ///< false: stopped
    void encode_loop(const std::stop_token& stop);
    void log_frame(const RenderedFrame& frame) const;

    FrameRenderer renderer_;
    ChannelClock clock_;
    std::shared_ptr<feed::Feed> feed_;
    ChannelMetrics metrics_;
    Handoff<RenderedFrame> rendered_;
    std::jthread encode_thread_;
    std::jthread render_thread_;
};

} // namespace fieldcast::channel
