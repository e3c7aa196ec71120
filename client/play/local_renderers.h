// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/play/play_options.h"
#include "client/play/scene_player.h"
#include "client/play/warp_player.h"
#include "core/wire/view_set.h"

#include <memory>
#include <optional>
#include <stop_token>

namespace fieldcast::client::play {

/// The device and the renderers with which this client makes views itself: in modes kScene and kWarp.
class LocalRenderers {
public:
    /// The renderers for all modes that `options` may require on the running stream; null: the server makes all views.
    /// Fetches the scene if one needs it. Throws NoDeviceForViews, and what obtain_scene() throws.
    static std::unique_ptr<LocalRenderers> make(const PlayOptions& options, const std::stop_token& stop);

    /// Of the scene that was fetched; empty: none.
    std::optional<scene::SceneHash> scene_hash() const { return hash_; }

    /// Makes the views of `set` from a frame of `mode`. Fails for frames whose contents do not match.
    Decoded<Views> play(DeliveryMode mode, const SourceFrame& frame, const wire::ViewSet& set);

    /// All planes of the last frame of mode kScene, of which there must have been one.
    SourceFrame source() { return scene_->source(); }

private:
    explicit LocalRenderers(const gpu::DeviceOptions& options) : device_(options) {}

    gpu::Device device_; ///< first, so that it outlives its renderers
    std::optional<scene::SceneHash> hash_;
    std::optional<ScenePlayer> scene_;
    std::optional<WarpPlayer> warp_;
};

} // namespace fieldcast::client::play
