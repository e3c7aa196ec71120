// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/gltf/accessors.h"
#include "core/scene/gltf/nodes.h"

#include <vector>

namespace fieldcast::scene {

/// Channels of all animations that move nodes of the scene. Marks those nodes and their descendants. Throws UserError.
std::vector<AnimationChannel> read_animations(GltfDocument& document, GltfAccessors& accessors, GltfNodes& nodes);

} // namespace fieldcast::scene
