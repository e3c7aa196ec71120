// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/channel/channel_clock.h"
#include "server/channel/channel_metrics.h"
#include "server/channel/device_turns.h"
#include "server/channel/frame_renderer.h"
#include "server/channel/handoff.h"
#include "server/feed/feed.h"

#include <functional>
#include <memory>
#include <optional>
#include <thread>

namespace fieldcast::channel {

/// A scene, a camera, a clock and a lattice of views. Renders the planes and views that subscribers of its feed want
/// and have room for, and sleeps while there are none.
/// One thread renders, another encodes and publishes the previous frame; neither ever waits for a client.
class Channel {
public:
    /// What all channels of a server share.
    struct Shared {
        const gpu::Device& device;
        const Settings& settings;
        DeviceTurns& turns; ///< at `device`
        metrics::Registry& registry;
        std::shared_ptr<feed::ViewMemory> view_memory; ///< its limit is for the views of all channels
    };

    /// Ready to serve when constructed; rendering starts with the first subscriber. What `shared` refers to must
    /// outlive it. Throws UserError if the scene is not usable.
    Channel(const Shared& shared, const ChannelChoice& choice);

    /// The client that owns this camera and is charged for its frames.
    struct Client {
        std::shared_ptr<feed::Feed> feed;
        std::function<void(std::chrono::duration<double>)> used; ///< device time of each frame
        ChannelClock::TimePoint begin; ///< of the scene time, the same for all clients of a channel
        std::weak_ptr<feed::Feed> server; ///< also fails if the device is lost
    };

    /// The camera of one client; renders into that client's feed.
    Channel(const Shared& shared, const SettledChannel& settled, Client client);
    ~Channel();

    const std::shared_ptr<feed::Feed>& feed() const { return feed_; }

private:
    template <class Work> void run(const Work& work); ///< body of a thread; a failure ends the channel, not the process
    void fail(const char* problem);
    void render_loop(const std::stop_token& stop);
    /// Waits for the device. Empty: stopped.
    std::optional<RenderedFrame> render_in_turn(std::uint64_t frame_id, const feed::Demand& demand,
                                                const std::stop_token& stop);
    FrameMoment next_moment(ChannelClock::TimePoint now); ///< of the frame that begins now
    bool wait_for_demand(const std::stop_token& stop); ///< false: stopped
    void forget_views(); ///< frees views that no client has wanted for a while
    void encode_loop(const std::stop_token& stop);
    void log_frame(const RenderedFrame& frame) const;

    const gpu::Device& device_;
    FrameRenderer renderer_;
    ChannelClock clock_;
    Client client_; ///< empty for a channel that all clients share
    std::shared_ptr<feed::Feed> feed_;
    ChannelMetrics metrics_;
    DevicePlace place_;
    Handoff<RenderedFrame> rendered_;
    std::jthread encode_thread_;
    std::jthread render_thread_;
};

} // namespace fieldcast::channel
