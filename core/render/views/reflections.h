// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/recorder.h"
#include "core/lightfield/source_frame.h"
#include "core/scene/gpu_scene.h"
#include "shaders/shared/frame.h"

namespace fieldcast::render {

/// What smooth surfaces mirror, looked up anew in every view: their light depends on the viewer, and reprojected with
/// the surface it would look painted on. Reprojection lists their pixels; one ray from each finds what is mirrored
/// there.
class Reflections {
public:
    /// Binding set 1 of the kernel has `source_layout`.
    Reflections(const gpu::Device& device, const scene::GpuScene& scene, const gpu::BindingLayout& source_layout);

    /// Whether the frame's views have such surfaces, so that reprojection shall list them.
    bool are_wanted(const FrameHeader& header) const;

    /// Makes room for the list.
    void resize(std::uint64_t view_pixels);
    void forget() { pixels_ = {}; } ///< gives the room back
    const gpu::Buffer& pixels() const { return pixels_; } ///< the list; its length is kCounterReflections

    /// `params`: everything but the list. After reprojection, before layers are composited.
    void record(gpu::Recorder& recorder, shared::TraceListParams params, const gpu::Buffer& counters,
                const gpu::BindingSet& source);

private:
    const gpu::Device& device_;
    const scene::GpuScene& scene_;
    gpu::Kernel finish_;
    gpu::Kernel reflect_;
    gpu::Buffer pixels_;
};

} // namespace fieldcast::render
