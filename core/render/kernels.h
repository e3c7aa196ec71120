// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/raster_pipeline.h"
#include "core/scene/gpu_scene.h"

namespace fieldcast::render {

/// The embedded kernels (shaders/*.comp).
enum class KernelId {
    kBmfrEvaluate,
    kBmfrFit,
    kCascadeHoles,
    kCountHoles,
    kFilterHoles,
    kFilterPunctual,
    kFindLayers,
    kFinishList,
    kInterleaveSource,
    kKeepHoles,
    kLimitHistory,
    kListGroups,
    kListHoles,
    kMergeLight,
    kNameTriangles,
    kPackSource,
    kReflectViews,
    kReproject,
    kScanHoles,
    kShadeHoles,
    kShadeViews,
    kSourceSurfaces,
    kStartHoles,
    kSvgfAtrous,
    kSvgfVariance,
    kTemporal,
    kToneMap,
    kTraceHoles,
    kCompositeLayers,
    kTraceReference,
    kTraceSource,
    kVisibility,
    kWarpBounds,
    kWarpFill,
    kWarpLink,
    kWarpUnpack,
    kWarpViews,
};

/// The embedded pairs of shaders that draw (shaders/*.vert, *.frag).
enum class RasterId { kDrawBlend, kDrawVisibility };
gpu::RasterCode raster_code(RasterId id);

/// Code of a kernel, in the variant for `traversal` if it traces rays.
gpu::KernelCode kernel_code(KernelId id, scene::Traversal traversal);

/// A kernel that looks at the scene: set 0 is the scene's, `sets` follow from 1 on.
gpu::Kernel make_scene_kernel(const gpu::Device& device, const scene::GpuScene& scene, KernelId id,
                              std::uint32_t push_bytes, const std::vector<const gpu::BindingLayout*>& sets = {});

/// A kernel that does not.
gpu::Kernel make_plain_kernel(const gpu::Device& device, KernelId id, std::uint32_t push_bytes,
                              const std::vector<const gpu::BindingLayout*>& sets = {});

} // namespace fieldcast::render
