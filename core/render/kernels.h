// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/raster_pipeline.h"
#include "core/scene/gpu_scene.h"
#include "shaders/kernel_ids.h" // KernelId: one for each of shaders/*.comp

namespace fieldcast::render {

/// The embedded pairs of vertex and fragment shaders (shaders/*.vert, *.frag).
enum class RasterId { kDrawBlend, kDrawVisibility };
gpu::RasterCode raster_code(RasterId id);

/// Code of a kernel; kernels that trace rays come in the variant for `traversal`.
gpu::KernelCode kernel_code(KernelId id, scene::Traversal traversal);

/// A kernel that reads the scene: binding set 0 is the scene's, `sets` are numbered from 1.
gpu::Kernel make_scene_kernel(const gpu::Device& device, const scene::GpuScene& scene, KernelId id,
                              std::uint32_t push_bytes, const std::vector<const gpu::BindingLayout*>& sets = {});

/// A kernel that does not read the scene.
gpu::Kernel make_plain_kernel(const gpu::Device& device, KernelId id, std::uint32_t push_bytes,
                              const std::vector<const gpu::BindingLayout*>& sets = {});

} // namespace fieldcast::render
