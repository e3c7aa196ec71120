// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/raster_pipeline.h"
#include "core/scene/gpu_scene.h"
#include "shaders/kernel_ids.h" // KernelId: one for each of shaders/*.comp

namespace fieldcast::render {

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
