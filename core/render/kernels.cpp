// SPDX-License-Identifier: Apache-2.0
#include "core/render/kernels.h"

#include "shaders/draw_blend_frag.spv.h"
#include "shaders/draw_visibility_frag.spv.h"
#include "shaders/draw_visibility_vert.spv.h"
#include "shaders/kernel_code.h"

#include "core/base/error.h"

#include <algorithm>

namespace fieldcast::render {

namespace {

/// A kernel's code for both traversals; the two are equal for kernels that trace no rays.
struct EmbeddedKernel {
    KernelId id;
    const char* name;
    std::span<const std::uint32_t> bvh;
    std::span<const std::uint32_t> ray_query;
};

const EmbeddedKernel kKernels[] = {
#include "shaders/kernel_rows.inc"
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
    FC_ASSERT(false, "unknown raster shaders");
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
