// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/recorder.h"
#include "core/render/source/source_surfaces.h"

namespace fieldcast::render {

/// Makes one plane of both kinds of illumination: light that, taken for both, makes the source look the same. Other
/// views differ by what changes between their pixels and the source's: docs/decisions/0013-one-light-plane.md. Not
/// thread-safe.
class LightMerger {
public:
    LightMerger(const gpu::Device& device, const scene::GpuScene& scene);

    /// Of all pages of `planes`, as `surfaces` has recorded them last. `cameras` is the device address of the sources'
    /// CameraRecords. Blocks.
    Plane merge(const SourcePlanes& planes, const SourceSurfaces& surfaces, std::uint64_t cameras);

private:
    const gpu::Device& device_;
    const scene::GpuScene& scene_;
    gpu::Recorder recorder_;
    gpu::Kernel kernel_;
    gpu::Buffer light_;
};

} // namespace fieldcast::render
