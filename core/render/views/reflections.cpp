// SPDX-License-Identifier: Apache-2.0
#include "core/render/views/reflections.h"

#include "core/render/kernels.h"

#include <algorithm>

namespace fieldcast::render {

Reflections::Reflections(const gpu::Device& device, const scene::GpuScene& scene,
                         const gpu::BindingLayout& source_layout)
    : device_(device), scene_(scene),
      finish_(make_plain_kernel(device, KernelId::kFinishList, sizeof(shared::FinishListParams))),
      reflect_(make_scene_kernel(device, scene, KernelId::kReflectViews, sizeof(shared::TraceListParams),
                                 {&source_layout})) {}

bool Reflections::are_wanted(const FrameHeader& header) const {
    return header.settings.reflections && scene_.has_glossy();
}

void Reflections::resize(std::uint64_t view_pixels) {
    const std::uint64_t bytes = scene_.has_glossy() ? view_pixels * 4 : 16;
    if (pixels_.size_bytes() < bytes) {
        pixels_ = gpu::Buffer(device_, bytes);
    }
}

void Reflections::record(gpu::CommandRecorder& recorder, shared::TraceListParams params, const gpu::Buffer& counters,
                         const gpu::BindingSet& source) {
    params.list = pixels_.address();
    recorder.stage("reflections");
    recorder.dispatch(finish_, {},
                      shared::FinishListParams{counters.address(), shared::kCounterReflections, shared::kLinearGroup},
                      {1, 1, 1});
    recorder.barrier();
    recorder.dispatch_indirect(reflect_, {&scene_.bindings(), &source}, params, counters,
                               (shared::kCounterReflections + 1) * 4);
    recorder.barrier();
}

} // namespace fieldcast::render
