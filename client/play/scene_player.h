// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/device.h"
#include "core/render/source/source_renderer.h"
#include "core/render/views/grid_renderer.h"
#include "core/wire/frame_assembler.h"

#include <string>

namespace fieldcast::client::play {

/// Makes views from source frames with our own copy of the scene: the renderers are those of the server.
class ScenePlayer {
public:
    /// `device` must outlive this. `traversal` as in scene::choose_traversal, `visibility` as in
    /// scene::choose_visibility.
    ScenePlayer(const gpu::Device& device, scene::Scene scene, const std::string& traversal,
                const std::string& visibility);

    /// Poses the scene from the frame's header and nothing else, rebuilds the G-buffer planes if the frame lacks any,
    /// and makes the views of `set`. Fails for frames that do not fit together.
    Decoded<Views> play(const SourceFrame& frame, const wire::ViewSet& set);

    /// All planes of the last played frame, received or rebuilt.
    SourceFrame source() const;

private:
    scene::Scene scene_;
    scene::GpuScene gpu_scene_;
    render::SourcePlanes planes_;
    render::SurfacePlanesRenderer surfaces_;
    render::GridRenderer views_;
};

} // namespace fieldcast::client::play
