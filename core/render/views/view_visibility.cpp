// SPDX-License-Identifier: Apache-2.0
#include "core/render/views/view_visibility.h"

#include "core/render/kernels.h"
#include "core/render/views/drawn_visibility.h"
#include "shaders/shared/frame.h"

namespace fieldcast::render {

ViewVisibility::ViewVisibility(const gpu::Device& device, const scene::GpuScene& scene)
    : scene_(scene), trace_(make_scene_kernel(device, scene, KernelId::kVisibility, sizeof(shared::VisibilityParams))) {
    if (const scene::DrawGeometry* geometry = scene.draw_geometry()) {
        drawn_ = std::make_unique<DrawnVisibility>(device, scene, *geometry);
    }
}

ViewVisibility::~ViewVisibility() = default;

void ViewVisibility::record(gpu::CommandRecorder& recorder, const VisibilityBatch& batch) {
    if (drawn_ != nullptr && (scene_.visibility() == scene::VisibilityMethod::kRaster || drawn_->is_fast(batch))) {
        drawn_->record(recorder, batch);
    } else {
        trace(recorder, batch);
    }
}

void ViewVisibility::trace(gpu::CommandRecorder& recorder, const VisibilityBatch& batch) const {
    shared::VisibilityParams params{};
    params.cameras = batch.camera_records;
    params.visibility = batch.visibility->address();
    params.layers = batch.layers->address();
    params.width = batch.cameras.front().width_px;
    params.height = batch.cameras.front().height_px;
    params.view_count = static_cast<std::uint32_t>(batch.cameras.size());
    recorder.dispatch(trace_, {&scene_.bindings()}, params,
                      {gpu::groups_for(params.width, 8), gpu::groups_for(params.height, 8), params.view_count});
}

} // namespace fieldcast::render
