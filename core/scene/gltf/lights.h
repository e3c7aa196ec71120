// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/gltf/nodes.h"

#include <vector>

namespace fieldcast::scene {

/// KHR_lights_punctual of the nodes, in their order. Throws UserError.
std::vector<Light> read_lights(const GltfDocument& document, const GltfNodes& nodes);

/// Perspective cameras of the nodes, in their order. Other cameras are counted in a warning. Throws UserError.
std::vector<CameraNode> read_cameras(GltfDocument& document, const GltfNodes& nodes);

} // namespace fieldcast::scene
