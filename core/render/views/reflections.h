// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/command_recorder.h"
#include "core/lightfield/source_frame.h"
#include "core/scene/gpu_scene.h"
#include "shaders/shared/frame.h"

namespace fieldcast::render {

/// Reflections in smooth surfaces, traced for every view: they depend on the viewing direction and, if reprojected with
/// the surface, would look painted on. Reprojection lists the pixels of such surfaces, and one ray per pixel finds the
/// reflected surface.
class Reflections {
public:
    /// `source_layout`: layout of binding set 1 of the kernel.
    Reflections(const gpu::Device& device, const scene::GpuScene& scene, const gpu::BindingLayout& source_layout);

    /// Whether the frame's views need reflections. Reprojection must then list the pixels.
    bool are_wanted(const FrameHeader& header) const;

    /// Makes room for a list of `view_pixels` pixels.
    void resize(std::uint64_t view_pixels);
    void forget() { pixels_ = {}; } ///< frees the list
    const gpu::Buffer& pixels() const { return pixels_; } ///< the list; counter kCounterReflections holds its length

    /// Records the pass; call after reprojection and before layers are composited. `params.list` is set here.
    void record(gpu::CommandRecorder& recorder, shared::TraceListParams params, const gpu::Buffer& counters,
                const gpu::BindingSet& source);

private:
    const gpu::Device& device_;
    const scene::GpuScene& scene_;
    gpu::Kernel finish_;
    gpu::Kernel reflect_;
    gpu::Buffer pixels_;
};

} // namespace fieldcast::render
