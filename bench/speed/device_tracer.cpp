// SPDX-License-Identifier: Apache-2.0
#include "bench/speed/device_tracer.h"

#include "shaders/shared/bvh.h"
#include "shaders/trace_rays_any_alpha_bvh.spv.h"
#include "shaders/trace_rays_any_alpha_rayquery.spv.h"
#include "shaders/trace_rays_any_bvh.spv.h"
#include "shaders/trace_rays_any_rayquery.spv.h"
#include "shaders/trace_rays_closest_alpha_bvh.spv.h"
#include "shaders/trace_rays_closest_alpha_rayquery.spv.h"
#include "shaders/trace_rays_closest_bvh.spv.h"
#include "shaders/trace_rays_closest_rayquery.spv.h"

#include <chrono>

namespace fieldcast::bench {

namespace {

struct KernelPair {
    gpu::KernelCode closest;
    gpu::KernelCode any;
};

KernelPair solid_kernels(scene::Traversal traversal) {
    if (traversal == scene::Traversal::kRayQuery) {
        return {{"trace_rays_closest_rayquery", trace_rays_closest_rayquery_spv},
                {"trace_rays_any_rayquery", trace_rays_any_rayquery_spv}};
    }
    return {{"trace_rays_closest_bvh", trace_rays_closest_bvh_spv}, {"trace_rays_any_bvh", trace_rays_any_bvh_spv}};
}

KernelPair alpha_kernels(scene::Traversal traversal) {
    if (traversal == scene::Traversal::kRayQuery) {
        return {{"trace_rays_closest_alpha_rayquery", trace_rays_closest_alpha_rayquery_spv},
                {"trace_rays_any_alpha_rayquery", trace_rays_any_alpha_rayquery_spv}};
    }
    return {{"trace_rays_closest_alpha_bvh", trace_rays_closest_alpha_bvh_spv},
            {"trace_rays_any_alpha_bvh", trace_rays_any_alpha_bvh_spv}};
}

} // namespace

DeviceRays::DeviceRays(const gpu::Device& device, std::span<const shared::TraceRay> rays)
    : device_(device), count_(static_cast<std::uint32_t>(rays.size())), rays_(gpu::make_buffer(device, rays)),
      view_(device, rays_, VK_FORMAT_R32G32B32A32_SFLOAT), hits_(device, rays.size() * sizeof(shared::TraceHit)),
      transmittances_(device, rays.size() * sizeof(float)) {}

std::vector<shared::TraceHit> DeviceRays::hits() const {
    return gpu::read_buffer_as<shared::TraceHit>(device_, hits_, count_);
}

std::vector<float> DeviceRays::transmittances() const {
    return gpu::read_buffer_as<float>(device_, transmittances_, count_);
}

DeviceTracer::DeviceTracer(const gpu::Device& device, const scene::Acceleration& acceleration,
                           scene::Traversal traversal)
    : device_(device), rays_layout_(device, {{shared::kBindRays}}), recorder_(device) {
    own_layout_.emplace(device, scene::Acceleration::bindings(traversal));
    own_set_.emplace(device, *own_layout_);
    acceleration.bind(*own_set_);
    const gpu::KernelLayout layout{{&*own_layout_, &rays_layout_}, sizeof(shared::TraceRaysParams)};
    std::vector<gpu::Specialisation> specialisations = acceleration.specialisations();
    for (gpu::Specialisation& specialisation : specialisations) {
        if (specialisation.id == shared::kSpecialiseAlpha) {
            specialisation.value = 0;
        }
    }
    const KernelPair kernels = solid_kernels(traversal);
    closest_ = gpu::Kernel(device, kernels.closest, layout, specialisations);
    any_ = gpu::Kernel(device, kernels.any, layout, specialisations);
}

DeviceTracer::DeviceTracer(const gpu::Device& device, const scene::GpuScene& scene)
    : device_(device), scene_set_(&scene.bindings()), rays_layout_(device, {{shared::kBindRays}}), recorder_(device) {
    const gpu::KernelLayout layout{{&scene.layout(), &rays_layout_}, sizeof(shared::TraceRaysParams)};
    const KernelPair kernels = alpha_kernels(scene.traversal());
    closest_ = gpu::Kernel(device, kernels.closest, layout, scene.specialisations());
    any_ = gpu::Kernel(device, kernels.any, layout, scene.specialisations());
}

double DeviceTracer::trace(const gpu::Kernel& kernel, const DeviceRays& rays, TraceMode mode, std::uint32_t seed) {
    gpu::BindingSet rays_set(device_, rays_layout_);
    rays_set.set(shared::kBindRays, rays.view_);
    shared::TraceRaysParams params{};
    params.hits = rays.hits_.address();
    params.transmittances = rays.transmittances_.address();
    params.ray_count = rays.count_;
    params.mode = static_cast<std::uint32_t>(mode);
    params.seed = seed;
    recorder_.dispatch(kernel, {own_set_ ? &*own_set_ : scene_set_, &rays_set}, params,
                       {gpu::groups_for(rays.count_, shared::kTraceRaysGroup)});
    recorder_.barrier();
    const auto start = std::chrono::steady_clock::now();
    recorder_.submit();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double DeviceTracer::trace_closest(const DeviceRays& rays, TraceMode mode, std::uint32_t seed) {
    return trace(closest_, rays, mode, seed);
}

double DeviceTracer::trace_any(const DeviceRays& rays) {
    return trace(any_, rays, TraceMode::kSolid, 0);
}

} // namespace fieldcast::bench
