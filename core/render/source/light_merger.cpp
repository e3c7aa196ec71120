// SPDX-License-Identifier: Apache-2.0
#include "core/render/source/light_merger.h"

#include "core/render/frame_parameters.h"
#include "core/render/kernels.h"
#include "shaders/shared/frame.h"

namespace fieldcast::render {

LightMerger::LightMerger(const gpu::Device& device, const scene::GpuScene& scene)
    : device_(device), scene_(scene), recorder_(device),
      kernel_(make_scene_kernel(device, scene, KernelId::kMergeLight, sizeof(shared::MergeLightParams))) {}

Plane LightMerger::merge(const SourcePlanes& planes, const SourceSurfaces& surfaces, std::uint64_t cameras) {
    const Camera widened = planes.camera();
    Plane plane{PlaneSemantic::kTotalLight, usual_format(PlaneSemantic::kTotalLight), widened.width_px,
                plane_height(planes.header(), PlaneSemantic::kTotalLight), {}};
    plane.bytes.resize(plane_bytes(plane.format, plane.width_px, plane.height_px));
    if (light_.size_bytes() < plane.bytes.size()) {
        light_ = gpu::Buffer(device_, plane.bytes.size());
    }
    shared::MergeLightParams params{};
    params.cameras = cameras;
    params.visibility = surfaces.visibility().address();
    params.layers = surfaces.layers().address();
    params.diffuse = planes.plane(PlaneSemantic::kDiffuse).address();
    params.specular = planes.plane(PlaneSemantic::kSpecular).address();
    params.light = light_.address();
    params.width = widened.width_px;
    params.height = widened.height_px;
    params.page_count = planes.page_count();
    params.source_count = planes.source_count();
    recorder_.stage("merge_light");
    recorder_.dispatch(kernel_, {&scene_.bindings()}, params, linear_groups(planes.texel_count()));
    recorder_.barrier();
    recorder_.submit();
    gpu::read_buffer(device_, light_, plane.bytes);
    return plane;
}

} // namespace fieldcast::render
