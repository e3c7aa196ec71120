// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/connection.h"
#include "core/lightfield/view_grid.h"
#include "core/scene/scene.h"

#include <cstddef>
#include <functional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

namespace fieldcast::client::net {

/// A channel, as the server describes it.
struct ChannelInfo {
    std::string name;
    scene::SceneHash scene_hash{};
    std::uint32_t source_width_px = 0; ///< without guard band
    std::uint32_t source_height_px = 0;
    float fovy_rad = 0.0F;
    float frames_per_second = 0.0F;
};

/// The server's channels in its order, at least one. Waits at most 5 s. Throws NetError.
std::vector<ChannelInfo> list_channels(const Connection& connection);

/// One piece of a scene bundle of `total_bytes`. Pieces come in order and without gaps.
struct BundlePiece {
    std::uint64_t total_bytes = 0;
    std::span<const std::byte> bytes;
};

/// Fetches the bundle of `hash` from byte `offset` on and passes each piece to `take`, which may throw to end the
/// transfer. Returns when the bundle is complete. Throws NetError, after a stop request a transient one.
void fetch_scene(const Connection& connection, const scene::SceneHash& hash, std::uint64_t offset,
                 const std::function<void(const BundlePiece&)>& take, const std::stop_token& stop);

} // namespace fieldcast::client::net
