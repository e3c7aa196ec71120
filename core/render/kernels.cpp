// SPDX-License-Identifier: Apache-2.0
#include "core/render/kernels.h"

#include "shaders/bmfr_evaluate.spv.h"
#include "shaders/bmfr_fit.spv.h"
#include "shaders/cascade_holes.spv.h"
#include "shaders/composite_layers_bvh.spv.h"
#include "shaders/composite_layers_rayquery.spv.h"
#include "shaders/count_holes.spv.h"
#include "shaders/draw_blend_frag.spv.h"
#include "shaders/draw_visibility_frag.spv.h"
#include "shaders/draw_visibility_vert.spv.h"
#include "shaders/filter_holes.spv.h"
#include "shaders/filter_punctual.spv.h"
#include "shaders/find_layers_bvh.spv.h"
#include "shaders/find_layers_rayquery.spv.h"
#include "shaders/finish_list.spv.h"
#include "shaders/interleave_source.spv.h"
#include "shaders/keep_holes.spv.h"
#include "shaders/limit_history.spv.h"
#include "shaders/list_groups.spv.h"
#include "shaders/list_holes.spv.h"
#include "shaders/merge_light.spv.h"
#include "shaders/name_triangles.spv.h"
#include "shaders/pack_source.spv.h"
#include "shaders/reflect_views_bvh.spv.h"
#include "shaders/reflect_views_rayquery.spv.h"
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
#include "shaders/warp_bounds.spv.h"
#include "shaders/warp_fill.spv.h"
#include "shaders/warp_link.spv.h"
#include "shaders/warp_unpack.spv.h"
#include "shaders/warp_views.spv.h"

#include "core/base/error.h"

#include <algorithm>

namespace fieldcast::render {

namespace {

/// A kernel for both ways of traversal; those that trace no rays have the same code for both.
struct EmbeddedKernel {
    KernelId id;
    const char* name;
    std::span<const std::uint32_t> bvh;
    std::span<const std::uint32_t> ray_query;
};

const EmbeddedKernel kKernels[] = {
    {KernelId::kBmfrEvaluate, "bmfr_evaluate", bmfr_evaluate_spv, bmfr_evaluate_spv},
    {KernelId::kBmfrFit, "bmfr_fit", bmfr_fit_spv, bmfr_fit_spv},
    {KernelId::kCascadeHoles, "cascade_holes", cascade_holes_spv, cascade_holes_spv},
    {KernelId::kCompositeLayers, "composite_layers", composite_layers_bvh_spv, composite_layers_rayquery_spv},
    {KernelId::kCountHoles, "count_holes", count_holes_spv, count_holes_spv},
    {KernelId::kFilterHoles, "filter_holes", filter_holes_spv, filter_holes_spv},
    {KernelId::kFilterPunctual, "filter_punctual", filter_punctual_spv, filter_punctual_spv},
    {KernelId::kFindLayers, "find_layers", find_layers_bvh_spv, find_layers_rayquery_spv},
    {KernelId::kFinishList, "finish_list", finish_list_spv, finish_list_spv},
    {KernelId::kInterleaveSource, "interleave_source", interleave_source_spv, interleave_source_spv},
    {KernelId::kKeepHoles, "keep_holes", keep_holes_spv, keep_holes_spv},
    {KernelId::kLimitHistory, "limit_history", limit_history_spv, limit_history_spv},
    {KernelId::kListGroups, "list_groups", list_groups_spv, list_groups_spv},
    {KernelId::kListHoles, "list_holes", list_holes_spv, list_holes_spv},
    {KernelId::kMergeLight, "merge_light", merge_light_spv, merge_light_spv},
    {KernelId::kNameTriangles, "name_triangles", name_triangles_spv, name_triangles_spv},
    {KernelId::kPackSource, "pack_source", pack_source_spv, pack_source_spv},
    {KernelId::kReflectViews, "reflect_views", reflect_views_bvh_spv, reflect_views_rayquery_spv},
    {KernelId::kReproject, "reproject", reproject_spv, reproject_spv},
    {KernelId::kScanHoles, "scan_holes", scan_holes_spv, scan_holes_spv},
    {KernelId::kShadeHoles, "shade_holes", shade_holes_spv, shade_holes_spv},
    {KernelId::kShadeViews, "shade_views", shade_views_spv, shade_views_spv},
    {KernelId::kSourceSurfaces, "source_surfaces", source_surfaces_spv, source_surfaces_spv},
    {KernelId::kStartHoles, "start_holes", start_holes_spv, start_holes_spv},
    {KernelId::kSvgfAtrous, "svgf_atrous", svgf_atrous_spv, svgf_atrous_spv},
    {KernelId::kSvgfVariance, "svgf_variance", svgf_variance_spv, svgf_variance_spv},
    {KernelId::kTemporal, "temporal", temporal_spv, temporal_spv},
    {KernelId::kToneMap, "tone_map", tone_map_spv, tone_map_spv},
    {KernelId::kTraceHoles, "trace_holes", trace_holes_bvh_spv, trace_holes_rayquery_spv},
    {KernelId::kTraceReference, "trace_reference", trace_reference_bvh_spv, trace_reference_rayquery_spv},
    {KernelId::kTraceSource, "trace_source", trace_source_bvh_spv, trace_source_rayquery_spv},
    {KernelId::kVisibility, "visibility", visibility_bvh_spv, visibility_rayquery_spv},
    {KernelId::kWarpBounds, "warp_bounds", warp_bounds_spv, warp_bounds_spv},
    {KernelId::kWarpFill, "warp_fill", warp_fill_spv, warp_fill_spv},
    {KernelId::kWarpLink, "warp_link", warp_link_spv, warp_link_spv},
    {KernelId::kWarpUnpack, "warp_unpack", warp_unpack_spv, warp_unpack_spv},
    {KernelId::kWarpViews, "warp_views", warp_views_spv, warp_views_spv},
};

} // namespace

gpu::KernelCode kernel_code(KernelId id, scene::Traversal traversal) {
    const auto kernel = std::ranges::find(kKernels, id, &EmbeddedKernel::id);
    FC_ASSERT(kernel != std::end(kKernels), "unknown kernel");
    return {kernel->name, traversal == scene::Traversal::kBvh ? kernel->bvh : kernel->ray_query};
}

gpu::RasterCode raster_code(RasterId id) {
    const gpu::KernelCode vertex{"draw_visibility_vert", draw_visibility_vert_spv};
    switch (id) {
    case RasterId::kDrawBlend:
        return {vertex, {"draw_blend_frag", draw_blend_frag_spv}};
    case RasterId::kDrawVisibility:
        return {vertex, {"draw_visibility_frag", draw_visibility_frag_spv}};
    }
    FC_ASSERT(false, "unknown shaders");
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
