// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"
#include "core/render/warp/warp_renderer.h"
#include "core/wire/frame_assembler.h"

namespace fieldcast::client::play {

/// Makes views from the source's colour and depth, without the scene.
class WarpPlayer {
public:
    /// `device` must outlive this.
    explicit WarpPlayer(const gpu::Device& device) : renderer_(device) {}

    /// Makes the views of `set`. Fails for frames that do not fit together.
    Decoded<Views> play(const SourceFrame& frame, const wire::ViewSet& set);

private:
    render::WarpRenderer renderer_;
};

} // namespace fieldcast::client::play
