// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/recorder.h"
#include "core/lightfield/camera.h"
#include "core/scene/gpu_scene.h"

#include <memory>
#include <span>

namespace fieldcast::render {

class DrawnVisibility;

/// Views of equal size, and where goes what their pixels see.
struct VisibilityBatch {
    std::span<const Camera> cameras;
    std::uint64_t camera_records = 0;        ///< device address of their CameraRecords
    const gpu::Buffer* visibility = nullptr; ///< Visibility: (instance, primitive); views padded as in lib/views.glsl
    const gpu::Buffer* layers = nullptr;     ///< two more for BLEND surfaces in front; only if the scene has some
};

/// What every pixel of a batch of views sees, by rays or by drawing (scene::VisibilityMethod).
class ViewVisibility {
public:
    ViewVisibility(const gpu::Device& device, const scene::GpuScene& scene);
    ~ViewVisibility();

    /// Visible to later commands after a barrier.
    void record(gpu::Recorder& recorder, const VisibilityBatch& batch);

private:
    void trace(gpu::Recorder& recorder, const VisibilityBatch& batch) const;

    const scene::GpuScene& scene_;
    gpu::Kernel trace_;
    std::unique_ptr<DrawnVisibility> drawn_; ///< null: rays
};

} // namespace fieldcast::render
