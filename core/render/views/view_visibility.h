// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/command_recorder.h"
#include "core/render/views/visibility_batch.h"
#include "core/scene/gpu_scene.h"

#include <memory>

namespace fieldcast::render {

class DrawnVisibility;

/// Finds the visibility of a batch of views by rays or by drawing (scene::VisibilityMethod).
class ViewVisibility {
public:
    ViewVisibility(const gpu::Device& device, const scene::GpuScene& scene);
    ~ViewVisibility();

    /// Visible to later commands after a barrier.
    void record(gpu::CommandRecorder& recorder, const VisibilityBatch& batch);

private:
    void trace(gpu::CommandRecorder& recorder, const VisibilityBatch& batch) const;

    const scene::GpuScene& scene_;
    gpu::Kernel trace_;
    std::unique_ptr<DrawnVisibility> drawn_; ///< null: rays
};

} // namespace fieldcast::render
