// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/camera.h"
#include "core/scene/gpu_scene.h"

#include <span>
#include <vector>

namespace fieldcast::render {

/// View depth (metres; infinity: no surface) of every pixel of `camera` from its visibility (instance, primitive). The
/// host computes it from the scene's triangles, independently of the kernels.
std::vector<float> depth_of_visibility(const scene::GpuScene& scene, const Camera& camera,
                                       std::span<const glm::uvec2> visibility);

} // namespace fieldcast::render
