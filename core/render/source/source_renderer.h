// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/render/source/source_planes.h"
#include "core/scene/gpu_scene.h"

#include <memory>

namespace fieldcast::render {

/// Renders source frames: visibility, path tracing, temporal accumulation, denoiser, packing to wire precision.
/// Keeps the history of one camera. Not thread-safe.
class SourceRenderer {
public:
    SourceRenderer(const gpu::Device& device, const scene::GpuScene& scene);
    ~SourceRenderer();

    /// Renders the frame described by `header` with the scene in its current pose. All of `header` is input except
    /// render_times, layer_count and still_frames. The result stays valid until the next call; its header carries the
    /// stage times.
    const SourcePlanes& render(const FrameHeader& header);

    /// The illumination of the last frame as one plane, kTotalLight. Blocks.
    Plane total_light();

    /// Number of NaN or infinite samples that were dropped since construction. Must stay 0.
    std::uint64_t invalid_sample_count() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Fills the G-buffer planes (depth, normal, id, material) of `planes` from the scene in its current pose. Clients that
/// receive illumination only use it. The planes are bit-identical to the server's on the same device.
class SurfacePlanesRenderer {
public:
    SurfacePlanesRenderer(const gpu::Device& device, const scene::GpuScene& scene);
    ~SurfacePlanesRenderer();
    void render(SourcePlanes& planes);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::render
