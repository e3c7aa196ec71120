// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/scene.h"

namespace fieldcast::scene {

/// Largest coordinate of anything in a scene, metres. Beyond it, single precision is too coarse and soon overflows.
inline constexpr float kMaxExtent_m = 1e9F;

/// Throws UserError unless all nodes and instances lie within `kMaxExtent_m`, at samples of the whole animation, and at
/// least one triangle is shown. The check is needed because products of finite numbers may be infinite.
void check_extent(const Scene& scene);

} // namespace fieldcast::scene
