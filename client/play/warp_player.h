// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"
#include "core/render/warp/warp_renderer.h"
#include "core/wire/view_set.h"

namespace fieldcast::client::play {

/// Makes views from the source's colour and depth, without the scene.
class WarpPlayer {
public:
    /// `device` must outlive this.
    explicit WarpPlayer(const gpu::Device& device) : renderer_(device) {}

    /// Makes the views of `set`. Fails for frames whose contents do not match.
    Decoded<Views> play(const SourceFrame& frame, const wire::ViewSet& set);

private:
    render::WarpRenderer renderer_;
};

} // namespace fieldcast::client::play
