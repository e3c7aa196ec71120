// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"
#include "server/camera/own_cameras.h"
#include "server/channel/channel.h"
#include "server/recording/channel_recorder.h"
#include "server/recording/replay.h"

#include <memory>
#include <optional>
#include <vector>

namespace fieldcast::channel {

/// All channels of a server, rendered or replayed, and their recorders. Opens a device only if a channel is
/// rendered.
class ChannelList {
public:
    /// All channels are ready when constructed. `settings` and `registry` must outlive it. Throws UserError if a scene
    /// or a recording is not usable, or two channels have one name.
    ChannelList(const Settings& settings, metrics::Registry& registry);

    const std::vector<std::shared_ptr<feed::Feed>>& feeds() const { return feeds_; } ///< those of scenes first

private:
    void start_channels(const Settings& settings, metrics::Registry& registry);
    void start_channel(const Channel::Shared& shared, const ChannelChoice& choice);
    void limit_view_memory(const Settings& settings);
    void start_replays(const Settings& settings, metrics::Registry& registry);
    void start_recorders(const Settings& settings, metrics::Registry& registry);
    void add_feed(const std::shared_ptr<feed::Feed>& feed);

    std::optional<gpu::Device> device_;
    DeviceTurns turns_; ///< at the device
    const std::shared_ptr<feed::ViewMemory> view_memory_ = std::make_shared<feed::ViewMemory>(0); ///< of the device
    std::vector<std::shared_ptr<feed::Feed>> feeds_;
    std::optional<camera::OwnCameras> own_cameras_;
    std::vector<std::unique_ptr<Channel>> channels_;
    std::vector<std::unique_ptr<recording::Replay>> replays_;
    std::vector<std::unique_ptr<recording::ChannelRecorder>> recorders_; ///< last: end before their feeds
};

} // namespace fieldcast::channel
