// SPDX-License-Identifier: Apache-2.0
#include "core/render/kernels.h"

#include "shaders/cascade_holes.spv.h"
#include "shaders/composite_layers_bvh.spv.h"
#include "shaders/composite_layers_rayquery.spv.h"
#include "shaders/count_holes.spv.h"
#include "shaders/filter_holes.spv.h"
#include "shaders/finish_list.spv.h"
#include "shaders/interleave_source.spv.h"
#include "shaders/keep_holes.spv.h"
#include "shaders/limit_history.spv.h"
#include "shaders/list_holes.spv.h"
#include "shaders/pack_source.spv.h"
#include "shaders/reproject.spv.h"
#include "shaders/scan_holes.spv.h"
#include "shaders/shade_holes.spv.h"
#include "shaders/shade_views.spv.h"
#include "shaders/source_surfaces.spv.h"
#include "shaders/start_holes.spv.h"
#include "shaders/svgf_atrous.spv.h"
#include "shaders/svgf_variance.spv.h"
#include "shaders/temporal.spv.h"
#include "shaders/tone_map.spv.h"
#include "shaders/trace_holes_bvh.spv.h"
#include "shaders/trace_holes_rayquery.spv.h"
#include "shaders/trace_reference_bvh.spv.h"
#include "shaders/trace_reference_rayquery.spv.h"
#include "shaders/trace_source_bvh.spv.h"
#include "shaders/trace_source_rayquery.spv.h"
#include "shaders/visibility_bvh.spv.h"
#include "shaders/visibility_rayquery.spv.h"

#include "core/base/error.h"

namespace fieldcast::render {

gpu::KernelCode kernel_code(KernelId id, scene::Traversal traversal) {
    const bool bvh = traversal == scene::Traversal::kBvh;
    const auto traced = [bvh](const char* name, std::span<const std::uint32_t> own,
                              std::span<const std::uint32_t> query) {
        return gpu::KernelCode{name, bvh ? own : query};
    };
    switch (id) {
    case KernelId::kCascadeHoles:
        return {"cascade_holes", cascade_holes_spv};
    case KernelId::kCountHoles:
        return {"count_holes", count_holes_spv};
    case KernelId::kFilterHoles:
        return {"filter_holes", filter_holes_spv};
    case KernelId::kKeepHoles:
        return {"keep_holes", keep_holes_spv};
    case KernelId::kLimitHistory:
        return {"limit_history", limit_history_spv};
    case KernelId::kListHoles:
        return {"list_holes", list_holes_spv};
    case KernelId::kScanHoles:
        return {"scan_holes", scan_holes_spv};
    case KernelId::kShadeHoles:
        return {"shade_holes", shade_holes_spv};
    case KernelId::kShadeViews:
        return {"shade_views", shade_views_spv};
    case KernelId::kStartHoles:
        return {"start_holes", start_holes_spv};
    case KernelId::kFinishList:
        return {"finish_list", finish_list_spv};
    case KernelId::kInterleaveSource:
        return {"interleave_source", interleave_source_spv};
    case KernelId::kPackSource:
        return {"pack_source", pack_source_spv};
    case KernelId::kReproject:
        return {"reproject", reproject_spv};
    case KernelId::kSourceSurfaces:
        return {"source_surfaces", source_surfaces_spv};
    case KernelId::kSvgfAtrous:
        return {"svgf_atrous", svgf_atrous_spv};
    case KernelId::kSvgfVariance:
        return {"svgf_variance", svgf_variance_spv};
    case KernelId::kTemporal:
        return {"temporal", temporal_spv};
    case KernelId::kToneMap:
        return {"tone_map", tone_map_spv};
    case KernelId::kTraceHoles:
        return traced("trace_holes", trace_holes_bvh_spv, trace_holes_rayquery_spv);
    case KernelId::kCompositeLayers:
        return traced("composite_layers", composite_layers_bvh_spv, composite_layers_rayquery_spv);
    case KernelId::kTraceReference:
        return traced("trace_reference", trace_reference_bvh_spv, trace_reference_rayquery_spv);
    case KernelId::kTraceSource:
        return traced("trace_source", trace_source_bvh_spv, trace_source_rayquery_spv);
    case KernelId::kVisibility:
        return traced("visibility", visibility_bvh_spv, visibility_rayquery_spv);
    }
    FC_ASSERT(false, "unknown kernel");
    return {};
}

gpu::Kernel make_scene_kernel(const gpu::Device& device, const scene::GpuScene& scene, KernelId id,
                              std::uint32_t push_bytes, const std::vector<const gpu::BindingLayout*>& sets) {
    gpu::KernelLayout layout{{&scene.layout()}, push_bytes};
    layout.sets.insert(layout.sets.end(), sets.begin(), sets.end());
    return {device, kernel_code(id, scene.traversal()), layout, scene.specialisations()};
}

gpu::Kernel make_plain_kernel(const gpu::Device& device, KernelId id, std::uint32_t push_bytes,
                              const std::vector<const gpu::BindingLayout*>& sets) {
    return {device, kernel_code(id, scene::Traversal::kBvh), {sets, push_bytes}};
}

} // namespace fieldcast::render
