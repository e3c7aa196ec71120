// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/command_recorder.h"
#include "core/render/group_list.h"
#include "core/render/source/source_planes.h"
#include "core/scene/gpu_scene.h"

namespace fieldcast::render {

/// Visibility of the sources and the G-buffer planes computed from it. The server uses it for source frames, clients
/// that rebuild the planes use it, too: the same kernels give the same bits.
class SourceSurfaces {
public:
    SourceSurfaces(const gpu::Device& device, const scene::GpuScene& scene);

    /// Records visibility and surfaces for all pages of `planes` (sized for its header). `cameras` is the device
    /// address of the sources' CameraRecords; `geometry` a buffer of GeometryTexel.
    void record(gpu::CommandRecorder& recorder, const SourcePlanes& planes, std::uint64_t cameras,
                const gpu::Buffer& geometry);

    const gpu::Buffer& visibility() const { return visibility_; }
    const gpu::Buffer& layers() const { return layers_; }
    /// Parts of all pages that show a surface: groups of kLinearGroup pixels and the groups around them, or tiles.
    const GroupList& groups() const { return groups_; }
    const GroupList& tiles() const { return tiles_; }

private:
    const gpu::Device& device_;
    const scene::GpuScene& scene_;
    gpu::Kernel trace_;
    gpu::Kernel surfaces_;
    GroupList groups_;
    GroupList tiles_;
    gpu::Buffer visibility_;
    gpu::Buffer layers_; ///< BLEND surfaces, kMaxLayers per pixel
};

} // namespace fieldcast::render
