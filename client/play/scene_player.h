// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"
#include "core/render/source/source_renderer.h"
#include "core/render/views/grid_renderer.h"
#include "core/wire/view_set.h"

#include <string>

namespace fieldcast::client::play {

/// Makes views from source frames and our copy of the scene, with the server's renderers.
class ScenePlayer {
public:
    /// `device` must outlive this. `traversal` as in scene::choose_traversal, `visibility` as in
    /// scene::choose_visibility.
    ScenePlayer(const gpu::Device& device, scene::Scene scene, const std::string& traversal,
                const std::string& visibility);

    /// Poses the scene from the frame's header only, rebuilds the G-buffer planes if the frame lacks any, and makes the
    /// views of `set`. Fails for frames whose contents do not match.
    Decoded<Views> play(const SourceFrame& frame, const wire::ViewSet& set);

    /// All planes of the last frame, received or rebuilt.
    SourceFrame source() const;

private:
    scene::Scene scene_;
    scene::GpuScene gpu_scene_;
    render::SourcePlanes planes_;
    render::SurfacePlanesRenderer surfaces_;
    render::GridRenderer views_;
};

} // namespace fieldcast::client::play
