// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/configure.h"
#include "client/play/scene_player.h"
#include "client/play/warp_player.h"

#include <memory>
#include <stop_token>

namespace fieldcast::client::play {

struct PlayOptions;

/// Device and renderers of modes kScene and kWarp.
class RenderSide {
public:
    /// With what the options may come to need on the running stream; null: all views come finished. Fetches the scene.
    /// Throws NoDeviceForViews.
    static std::unique_ptr<RenderSide> make(const PlayOptions& options, const std::stop_token& stop);

    /// Of the scene that we have.
    std::optional<scene::SceneHash> scene_hash() const { return hash_; }

    /// Makes the views of `set` from a frame of mode `mode`.
    Decoded<Views> play(DeliveryMode mode, const SourceFrame& frame, const wire::ViewSet& set);

    /// Of the last frame of mode kScene.
    SourceFrame source() { return scene_->source(); }

private:
    explicit RenderSide(const gpu::DeviceOptions& options) : device_(options) {}

    gpu::Device device_; ///< first: outlives its renderers
    std::optional<scene::SceneHash> hash_;
    std::optional<ScenePlayer> scene_;
    std::optional<WarpPlayer> warp_;
};

} // namespace fieldcast::client::play
