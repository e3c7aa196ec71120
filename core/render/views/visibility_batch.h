// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/gpu/buffer.h"
#include "core/lightfield/camera.h"

#include <cstdint>
#include <span>

namespace fieldcast::render {

/// Views of equal size, and the buffers that receive their visibility.
struct VisibilityBatch {
    std::span<const Camera> cameras;
    std::uint64_t camera_records = 0;        ///< device address of their CameraRecords
    const gpu::Buffer* visibility = nullptr; ///< Visibility: (instance, primitive); views padded as in lib/views.glsl
    const gpu::Buffer* layers = nullptr;     ///< two more for BLEND surfaces in front; only if the scene has some
};

} // namespace fieldcast::render
