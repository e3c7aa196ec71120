// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/command_recorder.h"
#include "core/scene/acceleration.h"
#include "core/scene/gpu_scene.h"
#include "shaders/shared/trace_rays.h"

#include <optional>

namespace fieldcast::bench {

/// Surfaces that rays can hit, as kTrace… in shaders/lib/traversal.glsl.
enum class TraceMode : std::uint32_t { kSolid = 0, kBlend = 1, kStochastic = 2 };

/// A batch of rays on the device, with room for results.
class DeviceRays {
public:
    DeviceRays(const gpu::Device& device, std::span<const shared::TraceRay> rays);

    std::uint32_t count() const { return count_; }
    std::vector<shared::TraceHit> hits() const; ///< of the last trace_closest()
    std::vector<float> transmittances() const;  ///< of the last trace_any()

private:
    friend class DeviceTracer;
    const gpu::Device& device_;
    std::uint32_t count_;
    gpu::Buffer rays_;
    gpu::TexelView view_;
    gpu::Buffer hits_;
    gpu::Buffer transmittances_;
};

/// Traces batches of rays on the device, through the kernels trace_rays_*.
class DeviceTracer {
public:
    /// Traces geometry only: all surfaces are opaque.
    DeviceTracer(const gpu::Device& device, const scene::Acceleration& acceleration, scene::Traversal traversal);
    /// Traces with the alpha tests of the scene's materials.
    DeviceTracer(const gpu::Device& device, const scene::GpuScene& scene);

    /// Both block until the device has finished and return seconds from submission to completion.
    double trace_closest(const DeviceRays& rays, TraceMode mode = TraceMode::kSolid, std::uint32_t seed = 0);
    double trace_any(const DeviceRays& rays);

private:
    double trace(const gpu::Kernel& kernel, const DeviceRays& rays, TraceMode mode, std::uint32_t seed);

    const gpu::Device& device_;
    std::optional<gpu::BindingLayout> own_layout_;
    std::optional<gpu::BindingSet> own_set_;
    const gpu::BindingSet* scene_set_ = nullptr;
    gpu::BindingLayout rays_layout_;
    gpu::Kernel closest_;
    gpu::Kernel any_;
    gpu::CommandRecorder recorder_;
};

} // namespace fieldcast::bench
