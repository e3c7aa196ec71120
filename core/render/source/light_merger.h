// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/command_recorder.h"
#include "core/render/source/source_surfaces.h"

namespace fieldcast::render {

/// Merges diffuse and specular illumination into one plane. Shaded with it in place of both, the source looks the same;
/// other views deviate where material or viewing angle change (docs/decisions/0013-one-light-plane.md). Not
/// thread-safe.
class LightMerger {
public:
    LightMerger(const gpu::Device& device, const scene::GpuScene& scene);

    /// Merges all pages of `planes`, which `surfaces` must have recorded last. `cameras` is the device address of the
    /// sources' CameraRecords. Blocks.
    Plane merge(const SourcePlanes& planes, const SourceSurfaces& surfaces, std::uint64_t cameras);

private:
    const gpu::Device& device_;
    const scene::GpuScene& scene_;
    gpu::CommandRecorder recorder_;
    gpu::Kernel kernel_;
    gpu::Buffer light_;
};

} // namespace fieldcast::render
