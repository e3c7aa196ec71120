// SPDX-License-Identifier: Apache-2.0
#include "core/render/source/source_surfaces.h"

#include "core/render/frame_parameters.h"
#include "core/render/kernels.h"
#include "core/render/view_request.h"
#include "shaders/shared/frame.h"

namespace fieldcast::render {

SourceSurfaces::SourceSurfaces(const gpu::Device& device, const scene::GpuScene& scene)
    : device_(device), scene_(scene),
      trace_(make_scene_kernel(device, scene, KernelId::kVisibility, sizeof(shared::VisibilityParams))),
      surfaces_(make_scene_kernel(device, scene, KernelId::kSourceSurfaces, sizeof(shared::SourceSurfacesParams))),
      groups_(device), tiles_(device) {}

void SourceSurfaces::record(gpu::CommandRecorder& recorder, const SourcePlanes& planes, std::uint64_t cameras,
                            const gpu::Buffer& geometry) {
    const Camera widened = planes.camera();
    const std::uint64_t padded = std::uint64_t{view_stride(widened.width_px, widened.height_px)} * planes.source_count();
    if (visibility_.size_bytes() < padded * 8) {
        visibility_ = gpu::Buffer(device_, padded * 8);
        layers_ = gpu::Buffer(device_, scene_.has_blend() ? padded * 16 : 16);
    }
    groups_.resize(gpu::groups_for(planes.texel_count(), shared::kLinearGroup));
    tiles_.resize(gpu::groups_for(widened.width_px, shared::kTileSide) *
                  gpu::groups_for(widened.height_px, shared::kTileSide) * planes.page_count());
    shared::VisibilityParams visible{};
    visible.cameras = cameras;
    visible.visibility = visibility_.address();
    visible.layers = layers_.address();
    visible.width = widened.width_px;
    visible.height = widened.height_px;
    visible.view_count = planes.source_count();
    recorder.stage("source_visibility");
    groups_.clear(recorder);
    tiles_.clear(recorder);
    recorder.dispatch(
        trace_, {&scene_.bindings()}, visible,
        {gpu::groups_for(widened.width_px, 8), gpu::groups_for(widened.height_px, 8), visible.view_count});
    recorder.barrier();

    shared::SourceSurfacesParams params{};
    params.cameras = cameras;
    params.visibility = visibility_.address();
    params.layers = layers_.address();
    params.depth = planes.plane(PlaneSemantic::kDepth).address();
    params.normal = planes.plane(PlaneSemantic::kNormal).address();
    params.id = planes.plane(PlaneSemantic::kId).address();
    params.material = planes.plane(PlaneSemantic::kMaterial).address();
    params.geometry = geometry.address();
    params.flags = groups_.flags().address();
    params.tile_flags = tiles_.flags().address();
    params.width = widened.width_px;
    params.height = widened.height_px;
    params.page_count = planes.page_count();
    params.source_count = planes.source_count();
    recorder.stage("source_surfaces");
    recorder.dispatch(surfaces_, {&scene_.bindings()}, params, linear_groups(planes.texel_count()));
    recorder.barrier();
    groups_.record(recorder, widened.width_px);
    tiles_.record(recorder, 0);
    recorder.barrier();
}

} // namespace fieldcast::render
